#pragma once

#include <optional>

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
};

/// Where a patch has no map by Method::spectral: the first accepted map of, in this order, the energy with thin
/// triangles clamped, the form B with the other measure, and the energy with the other weights. Raises `attempts` by
/// those made. Empty where none is accepted.
std::optional<FallbackMap> solve_fallback(const SpectralSolver& failed, const SolveOptions& options,
                                          const Pins& attractors, const Progress& progress, Timings& timings,
                                          int& attempts);

}  // namespace spectral_conformal
