#pragma once

#include <optional>

#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map of a patch with holes, and the rigidity of these that it has.
struct RigidMap {
  SpectralMap map;      ///< of rigidity 0 where none passes; it may be rejected
  double rigidity = 0;  ///< beta of ExtendedForm::add_spread
  int attempts = 0;     ///< eigenproblems solved, for all rigidities
  /// That of rigidity 0, where another one was chosen and this one passes, too.
  std::optional<SpectralMap> free = {};
};

/// The map of Method::spectral whose holes are as rigid as the patch bears.
///
/// A given rigidity is divided by four until the map passes its checks without flipped triangles; where it has some at
/// every rigidity, 0 included, the map with the fewest is taken, of several that with the highest rigidity.
///
/// Without one (SolveOptions::hole_rigidity), the map of rigidity 0, unless another has a lower mean QC, no more
/// flipped triangles, not more than twice the worst QC, and no border that crosses itself where that of rigidity 0 does
/// not. Where that of rigidity 0 has next to no distortion, no other
/// is tried.
///
/// options: without extenders. Throws what spectral_map throws.
RigidMap map_with_rigid_holes(SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                              Timings& timings);

/// Stage: the map whose holes are as rigid as the patch bears.
PatchMap with_rigid_holes(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
