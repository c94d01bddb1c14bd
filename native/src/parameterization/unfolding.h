#pragma once

#include "injective/fold_free_map.h"
#include "parameterization/patch_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map (V,) with its folds taken out, placed as before.
struct UnfoldedMap {
  FoldFreeMap fold_free;
  bool changed = false;       ///< whether the map was unfolded or replaced; otherwise only the mean QCs are filled in
  double mean_qc_before = 0;  ///< not a number where there was no map
  double mean_qc = 0;
  double eigenvalue = 0;  ///< the quotient of Eq. 5, in the units of the input
  double residual = 0;    ///< |L z - lambda B z|_2 / (largest diagonal entry of L x |z|_2)
  int turning_number = 0;
};

struct UnfoldingOptions {
  bool is_refused = false;   ///< the map is not placed and has not passed its checks: it is relaxed as a whole
  bool moves_apart = false;  ///< see FoldFreePatch
};

/// fold_free_map for the map z (V,) of a patch, or for none where z is empty. Pins hold their vertices. Throws
/// SolveFailure where what it ends with has no area, and what fold_free_map throws.
UnfoldedMap unfold(const SpectralProblem& problem, const Pins& held, const ComplexVector& z,
                   const UnfoldingOptions& options, const Progress& progress);

/// The map, or where it has none its rejection, as it was unfolded or replaced, and what that took and left.
PatchMap with_unfolded(const SolveTask& task, PatchMap map, UnfoldedMap&& unfolded);

/// Stage: unfolds the map, or embeds the patch where it has none, where PatchOptions::fold_free asks for it. Hard pins
/// have no embedding.
PatchMap unfolded(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
