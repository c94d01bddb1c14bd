#pragma once

#include <optional>

#include "parameterization/area_blend.h"
#include "parameterization/spectral_solver.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The map of another problem, and which it is.
struct FallbackMap {
  SpectralMap map;  ///< accepted
  Fallback fallback = Fallback::none;
  Weights weights = Weights::uniform;
  BoundaryMeasure boundary = BoundaryMeasure::length;
  int clamped_triangles = 0;
  std::optional<AreaBlend> blend;  ///< where the patch had none because its own conformal map fails
};

/// Where a patch has no map by Method::spectral: the first accepted map of, in this order, the energy with thin
/// triangles clamped, the form B with the other measure, and the energy with the other weights. area_blend: what each
/// of them is blended by first; 0 where the patch is blended already or not at all. Raises `attempts` by those made.
/// Empty where none is accepted.
std::optional<FallbackMap> solve_fallback(const SpectralSolver& failed, const SolveOptions& options,
                                          const Pins& attractors, double area_blend, const Progress& progress,
                                          Timings& timings, int& attempts);

}  // namespace spectral_conformal
