#pragma once

#include <optional>

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map of a patch with holes, and the rigidity of the holes.
struct RigidMap {
  SpectralMap map;      ///< of rigidity 0 if none passes; it may be rejected
  double rigidity = 0;  ///< beta of ExtendedForm::add_spread
  int attempts = 0;     ///< eigenproblems solved, for all rigidities
  /// The map of rigidity 0, if another was chosen and this one passes too.
  std::optional<SpectralMap> free = {};
};

/// The map of Method::spectral with the holes as rigid as the patch allows.
///
/// A given rigidity is lowered, to one of six from 10 to 0, until the map passes its checks without flipped triangles.
/// If every rigidity, including 0, has flipped triangles, the map with the fewest is taken, at the highest such
/// rigidity.
///
/// Without a given rigidity (SolveOptions::hole_rigidity), the result is the map of rigidity 0, unless another has a
/// lower mean QC, no more flipped triangles, at most twice the worst QC, and no self-crossing border where that of
/// rigidity 0 has none. If the map of rigidity 0 has next to no distortion, no other is tried.
///
/// options: without extenders. Throws as spectral_map does.
RigidMap map_with_rigid_holes(SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                              Timings& timings);

/// Stage: the map with the holes as rigid as the patch allows.
PatchMap with_rigid_holes(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
