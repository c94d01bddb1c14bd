#pragma once

#include <optional>

#include "spectral_conformal/relaxation_status.h"

namespace spectral_conformal {

/// Why a map is not accepted, or why there can be none.
enum class Rejection {
  none,
  not_factorized,  ///< L + s M, or the free part of L, is not positive definite in double precision
  not_converged,   ///< the eigenvalue iteration did not get near enough for the corrections
  not_finite,
  collapsed,       ///< the boundary shrinks to a point: no quotient of Eq. 5
  unresolved,      ///< it does not satisfy its equations in double precision
  no_area,         ///< the signed area is not positive
  winding,         ///< the boundary does not wind round once
  no_embedding,    ///< no embedding into a circle could be solved for
  too_large,       ///< the factor has more entries than int can number
  library_failed,  ///< the library of the factorization reported an error
  // Conditions that a chart breaks (chart_checks.h).
  vertex_not_finite,  ///< count: the vertex
  not_orientable,
  closed,         ///< count: handles
  handles,        ///< count
  no_extent,      ///< that double precision can hold
  border_of_two,  ///< vertices, between which no map can open
  no_surface      ///< the vertices lie on one line
};

/// The constraints that a map was solved with, and that may be the reason for what is wrong with it.
enum class Constraint { none, pins, extenders, rigidity, extenders_and_rigidity };

enum class StepKind {
  rejected,            ///< reason, attempts, constraint; count: turning number, or status of the library; after: shift
  retried,             ///< the map is that of the second attempt
  winds,               ///< count: turning number of a map of a method for which it need not be 1
  lowered_rigidity,    ///< of the holes, before -> after
  clamped_thin,        ///< of Fallback::clamped_triangles; count: triangles
  by_length,           ///< of Fallback::other_boundary
  by_vertex,           ///< likewise
  uniform_weights,     ///< of Fallback::other_weights
  inverse_area,        ///< likewise
  relaxed_with_flips,  ///< count: triangles of the relaxed map of the area blend without positive area
  blended_little,      ///< the area blend took the spread of scale (log2) from before to after; relaxation
  embedded,            ///< replaced by a relaxed embedding; mean QC before (not a number: no map) -> after
  unfolded,            ///< count: triangles that are no longer flipped; mean QC before -> after
  moved_apart,         ///< parts that lay on each other; mean QC before -> after
  moved_apart_embedded,  ///< likewise, in an embedding
  covers_itself,         ///< such parts remain
  still_flipped,         ///< count: triangles; constraint
  not_injective,         ///< count: turning number; if 1 or -1, triangles wind round an inner vertex; constraint
  unresolved_triangles,  ///< count: those of which the digits of the coordinates do not tell the corners apart
  reoriented_faces,      ///< count
  duplicate_faces,       ///< count: placed on the first face of the same vertices
  fan_splits,            ///< count: polygons that intersect themselves
  degenerate_triangles,  ///< count: given a minimal height
  shrunk_to_point,       ///< of a chart without area
  degenerate_faces,      ///< those that no chart can have
  out_of_memory          ///< count: faces of a chart
};

/// What a solve did besides the eigenproblem that was asked for, what there is to say of its map, or why it has none.
/// Members that StepKind does not name for a kind are as they are here.
struct Step {
  StepKind kind = StepKind::rejected;
  Rejection reason = Rejection::none;
  int count = 0;
  int attempts = 0;
  double before = 0;
  double after = 0;
  Constraint constraint = Constraint::none;
  std::optional<RelaxationStatus> relaxation = {};
};

/// Of a map that is rejected, or of a chart that can have none; count: see Rejection.
inline Step rejected(Rejection reason, int count = 0) { return {StepKind::rejected, reason, count}; }
inline Step counted(StepKind kind, int count) { return {kind, Rejection::none, count}; }
inline Step changed(StepKind kind, double before, double after, int count = 0) {
  return {kind, Rejection::none, count, 0, before, after};
}

}  // namespace spectral_conformal
