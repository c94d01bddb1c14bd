#pragma once

#include <optional>
#include <vector>

#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "relaxation/descent.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The input of fold_free_map for a chart. Virtual vertices and triangles of the energy are not used.
struct FoldFreePatch {
  const ConformalEnergy& energy;
  Eigen::Ref<const Positions> positions;   ///< (V, 3)
  const std::vector<BoundaryLoop>& loops;  ///< the outer one first
  const std::vector<char>& held;           ///< (V,) or empty: vertices that must not move
  FactorizationBackend backend = FactorizationBackend::automatic;
  bool relaxes = false;      ///< whether to relax an unfolded map as a whole, like an embedding
  bool moves_apart = false;  ///< whether to separate overlapping parts too
  /// DistortionMeasure::sizes of the relaxed maps. If positive, they are measured against the surface in 3D, without
  /// the metric of the energy.
  double sizes = 0;
};

struct FoldFreeMap {
  ComplexVector z;            ///< (V,)
  int flipped_before = 0;     ///< triangles without positive image area in the given map
  int flipped = 0;            ///< the same of z
  bool is_embedding = false;  ///< whether an embedding replaced the given map
  /// For an embedding, or a map relaxed as a whole: the outcome of the last descent. Empty if there was none, or its
  /// result was rejected.
  std::optional<Descent> relaxation;
  /// Whether z is locally one-to-one: no flipped triangle, and winding number 1 of the triangles around every
  /// inner vertex and of the outer loop.
  bool is_locally_injective = false;
  int turning_number = 0;            ///< of the outer loop, by one split of each quad
  bool covered_itself = false;       ///< whether it was locally one-to-one and yet overlapped itself; if requested
  bool covers_itself = false;        ///< whether z still overlaps itself
  bool came_apart_embedded = false;  ///< whether only an embedding separated the parts
};

/// A map without folds, of as little distortion as possible (DistortionMeasure; conformal by default). Flipped
/// triangles of the given map are unfolded locally (local_unfolding.h). If some remain, or if there is no map or its
/// boundary winds around more than once, an embedding of the chart replaces it (tutte_embedding.h, or grid_embedding.h
/// if limbs shrink below double precision); not with `held` vertices. The embedding is relaxed first toward an
/// isometry, then toward the least distortion, without folding a triangle (descent.h). The first split of a quad is
/// kept unfolded (the second if the diagonal of the first is an edge), the other if there is room. Degenerate triangles
/// cannot fold. If the resulting map is locally one-to-one but overlaps itself, and separation is requested, it is
/// relaxed toward an isometry until the parts separate. If they do not, an embedding is relaxed without letting its
/// boundary touch itself (boundary_barrier.h). If that fails too, or leaves
/// little but slivers, the map is kept, as it always is with `held` vertices.
///
/// z: (V,), mostly counterclockwise, or empty for none. Throws Cancelled, SolveFailure, and as Factorization does.
FoldFreeMap fold_free_map(const FoldFreePatch& patch, ComplexVector z, const Progress& progress = {});

}  // namespace spectral_conformal
