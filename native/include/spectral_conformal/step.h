#pragma once

#include <optional>

#include "spectral_conformal/relaxation_status.h"

namespace spectral_conformal {

/// Why a map is rejected, or what condition a chart, a mesh or an argument violates.
enum class Rejection {
  none,
  not_factorized,  ///< L + s M, or the free part of L, is not positive definite in double precision
  not_converged,   ///< the eigenvalue iteration stopped too far off for the corrections
  not_finite,
  collapsed,       ///< the boundary shrinks to a point: no quotient of Eq. 5
  unresolved,      ///< it does not satisfy its equations in double precision
  no_area,         ///< the signed area is not positive
  winding,         ///< the boundary does not wind around once
  folded,          ///< flipped triangles cover much of it; count: these
  no_embedding,    ///< no embedding into a circle was found
  too_large,       ///< the factor has more entries than int can number
  library_failed,  ///< the factorization library reported an error
  no_cholmod,      ///< asked for, but not in this build
  // Conditions that a chart violates (chart_checks.h).
  vertex_not_finite,  ///< count: the vertex
  not_orientable,
  closed,         ///< count: handles
  handles,        ///< count
  no_extent,      ///< that double precision can hold
  border_of_two,  ///< vertices: no map can open between them
  no_surface,     ///< the vertices lie on one line
  // Of meshes that are not a single patch (single_chart).
  degenerate_face,  ///< count: the first face with fewer than three different vertices
  no_faces,
  non_manifold_edges,  ///< count: with three or more faces
  several_components,  ///< count
  bow_ties,            ///< count: vertices where parts of the boundary touch
  // Of arrays that do not describe a mesh (validate); limit: the largest number allowed.
  too_many_vertices,  ///< count, limit; likewise the next three
  too_many_faces,
  too_many_corners,
  too_many_seam_edges,
  offsets_decrease,  ///< count: after this face
  offsets_not_from_zero,
  corner_of_no_vertex,  ///< count: the corner; index: the vertex; limit
  seam_of_no_vertex,    ///< count: the edge; index: the vertex; limit
  not_triangle,         ///< count: the face
  // Of UVs, metrics, pins and options.
  uv_not_finite,           ///< count: the corner; index: its face
  pinned_uv_not_finite,    ///< count: the face
  metric_not_positive,     ///< count: the face
  loop_without_length,     ///< BoundaryMeasure::length
  unused_pinned_vertex,    ///< count: the vertex, of no triangle
  unused_extender_vertex,  ///< likewise
  pins_at_one_position,
  too_many_pins,                ///< more copies of pinned vertices than int can number
  method_without_pins,          ///< three or more hard pins
  method_without_extenders,     ///< or hole rigidity where the map is held
  method_without_constraints,   ///< linear ones; likewise the next two
  constraints_join_vertices,    ///< count, index: the vertices of an edge without extent
  constraints_flatten_triangle  ///< count, index, limit: its vertices
};

/// The constraints of a solve, which may have caused a defect of its map.
enum class Constraint { none, pins, extenders, rigidity, extenders_and_rigidity, linear };

enum class StepKind {
  rejected,          ///< reason, attempts, constraint; count: turning number, triangles or library status; after: shift
  retried,           ///< the map comes from the second attempt
  winds,             ///< count: turning number, for a method where it need not be 1
  lowered_rigidity,  ///< of the holes, before -> after
  clamped_thin,      ///< of Fallback::clamped_triangles; count: triangles
  by_length,         ///< of Fallback::other_boundary
  by_vertex,         ///< likewise
  uniform_weights,   ///< of Fallback::other_weights
  inverse_area,      ///< likewise
  relaxed_with_flips,    ///< count: triangles without positive area in the area blend's relaxed map
  blended_little,        ///< the area blend took the spread of scale (log2) from before to after; relaxation
  embedded,              ///< replaced by a relaxed embedding; mean QC before (NaN: no map) -> after
  unfolded,              ///< count: triangles no longer flipped; mean QC before -> after
  moved_apart,           ///< overlapping parts separated; mean QC before -> after
  moved_apart_embedded,  ///< likewise, in an embedding
  covers_itself,         ///< overlapping parts remain
  still_flipped,         ///< count: triangles; constraint
  nearest_to_free,       ///< count: turning number of the map of least quotient under constraints, or 1: it had folds
  folds,                 ///< count: triangles that are flipped; constraint, which may have flipped them
  unmet_constraints,     ///< count: linear equations that the held coordinates contradict
  not_injective,         ///< count: turning number; if 1 or -1, triangles wind around an inner vertex; constraint
  unresolved_triangles,  ///< count: their corners coincide to the precision of the coordinates
  reoriented_faces,      ///< count
  duplicate_faces,       ///< count: mapped onto the first face with the same vertices
  fan_splits,            ///< count: polygons that intersect themselves
  degenerate_triangles,  ///< count: given a minimal height
  shrunk_to_point,       ///< of a chart without area
  degenerate_faces,      ///< faces that belong to no chart
  out_of_memory          ///< count: faces of a chart
};

/// What a solve did beyond the requested eigenproblem, a remark on its map, or why there is no map. Members that
/// StepKind does not list for a kind keep their defaults.
struct Step {
  StepKind kind = StepKind::rejected;
  Rejection reason = Rejection::none;
  int count = 0;
  int attempts = 0;
  double before = 0;
  double after = 0;
  Constraint constraint = Constraint::none;
  std::optional<RelaxationStatus> relaxation = {};
  int index = 0;  ///< see Rejection, like limit
  int limit = 0;
};

/// For a rejected map, or a chart or mesh that can have none; numbers: see Rejection.
inline Step rejected(Rejection reason, int count = 0, int index = 0, int limit = 0) {
  return {StepKind::rejected, reason, count, 0, 0, 0, Constraint::none, {}, index, limit};
}
inline Step counted(StepKind kind, int count) { return {kind, Rejection::none, count}; }
inline Step changed(StepKind kind, double before, double after, int count = 0) {
  return {kind, Rejection::none, count, 0, before, after};
}

}  // namespace spectral_conformal
