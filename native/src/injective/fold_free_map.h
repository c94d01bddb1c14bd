#pragma once

#include <optional>
#include <vector>

#include "conformal/conformal_energy.h"
#include "linear_algebra/factorization.h"
#include "relaxation/descent.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A chart as fold_free_map needs it. Virtual vertices and triangles of the energy are not used.
struct FoldFreePatch {
  const ConformalEnergy& energy;
  Eigen::Ref<const Positions> positions;   ///< (V, 3)
  const std::vector<BoundaryLoop>& loops;  ///< the outer one first
  const std::vector<char>& held;           ///< (V,) or empty: vertices that must stay
  FactorizationBackend backend = FactorizationBackend::automatic;
  bool relaxes = false;      ///< whether an unfolded map is relaxed as a whole, as an embedding is
  bool moves_apart = false;  ///< whether parts that lie on each other are to come apart, too
};

struct FoldFreeMap {
  ComplexVector z;            ///< (V,)
  int flipped_before = 0;     ///< triangles without positive image area in the given map
  int flipped = 0;            ///< the same of z
  bool is_embedding = false;  ///< whether the given map had to be given up for an embedding
  /// Of an embedding, or a map that is relaxed as a whole: how the last descent, of its conformal distortion, ended.
  /// None where there was no such descent, or its result was rejected.
  std::optional<Descent> relaxation;
  /// z has no flipped triangle, its triangles go round every inner vertex once, and the outer loop round the map once:
  /// it is locally one-to-one.
  bool is_locally_injective = false;
  int turning_number = 0;            ///< of the outer loop, by one split of each quad
  bool covered_itself = false;       ///< whether it was so, and yet had parts that lay on each other; if asked
  bool covers_itself = false;        ///< whether z still has such parts
  bool came_apart_embedded = false;  ///< whether they came apart only in an embedding
};

/// A map without folds, as near to a conformal one as it can be brought. Flipped triangles of the given map are
/// unfolded where they are (local_unfolding.h). Where that leaves some, or where there is no map or one whose boundary
/// winds round more than once, an embedding of the chart (tutte_embedding.h, or grid_embedding.h where limbs shrink in
/// it below double precision) is relaxed, first towards an isometry, then towards the least conformal distortion,
/// without a step that folds a triangle (descent.h); not with `held` vertices. Of a quad's two splits the first is kept
/// unfolded (the second where the diagonal of the first is an edge), the other where there is room. Degenerate
/// triangles have no fold. Where the map is then locally one-to-one and yet has parts that lie on each other, it is
/// relaxed towards an isometry, where that was asked for, only as far as these come apart; where they do not, an
/// embedding is relaxed whose boundary does not touch itself either (boundary_barrier.h). Where that fails, too, the
/// map stays.
///
/// z (V,) mostly counter-clockwise, or empty for none. Throws Cancelled, SolveFailure and what Factorization throws.
FoldFreeMap fold_free_map(const FoldFreePatch& patch, ComplexVector z, const Progress& progress = {});

}  // namespace spectral_conformal
