#pragma once

#include <optional>

#include "parameterization/spectral_solver.h"
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
/// options: without extenders. Uses the factor of the solver. Throws what SpectralSolver::solve throws.
RigidMap solve_with_rigid_holes(SpectralSolver& solver, const SolveOptions& options, const Progress& progress,
                                Timings& timings);

}  // namespace spectral_conformal
