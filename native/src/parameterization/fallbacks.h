#pragma once

#include <optional>

#include "parameterization/area_blend.h"
#include "parameterization/spectral_solver.h"
#include "parameterization/unfolding.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map that stands in for one that failed, and where it comes from.
struct FallbackMap {
  SpectralMap map;                      ///< accepted; of another problem
  std::optional<UnfoldedMap> unfolded;  ///< instead of `map`, for Fallback::unfolded and tutte_embedding
  Fallback fallback = Fallback::none;
  Weights weights = Weights::uniform;
  BoundaryMeasure boundary = BoundaryMeasure::length;
  int clamped_triangles = 0;
  std::optional<AreaBlend> blend;  ///< where the patch had none because its own conformal map fails
};

/// Where a patch has no map by Method::spectral: the one of least mean QC among those without flipped triangles, or, if
/// all have some, among those with the fewest, of
///   the rejected map itself, where it is there, its flipped triangles unfolded, or else an embedding, relaxed
///   (fold_free_map.h); the accepted maps of the energy with thin triangles clamped, of the form B with the other
///   measure, and of the energy with the other weights.
/// rejected: what solving the patch ended with. area_blend: what other problems are blended by first; 0 where the patch
/// is blended already or not at all. Where it is not 0, or there are attractors, these problems come first: the first
/// map knows neither. Raises `attempts` by the problems solved. Empty where there is none.
std::optional<FallbackMap> solve_fallback(const SpectralSolver& failed, const SpectralMap& rejected,
                                          const SolveOptions& options, const Pins& attractors, double area_blend,
                                          const Progress& progress, Timings& timings, int& attempts);

}  // namespace spectral_conformal
