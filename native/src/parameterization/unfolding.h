#pragma once

#include "injective/fold_free_map.h"
#include "parameterization/patch_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A map (V,) without its folds, placed as before.
struct UnfoldedMap {
  FoldFreeMap fold_free;
  bool changed = false;       ///< whether the map was unfolded or replaced; if not, only the mean QCs are set
  double mean_qc_before = 0;  ///< NaN if there was no map
  double mean_qc = 0;
  double eigenvalue = 0;  ///< the quotient of Eq. 5, in the units of the input
  double residual = 0;    ///< |L z - lambda B z|_2 / (largest diagonal entry of L x |z|_2)
  int turning_number = 0;
};

struct UnfoldingOptions {
  bool is_refused = false;   ///< the map was rejected and is not placed: relax it as a whole
  bool moves_apart = false;  ///< see FoldFreePatch
  double sizes = 0;          ///< likewise
};

/// Applies fold_free_map to the map z (V,) of a patch; an empty z means no map. Pins hold their vertices. Throws
/// SolveFailure if the result has no area, and as fold_free_map does.
UnfoldedMap unfold(const SpectralProblem& problem, const Pins& held, const ComplexVector& z,
                   const UnfoldingOptions& options, const Progress& progress);

/// FoldFreePatch::sizes for a patch: PatchOptions::area_blend, by which embeddings keep sizes as the blended metric
/// would. 0 with a metric from the caller, whose shapes are lost once it is blended.
double sizes_of(const PreparedPatch& patch);

/// The unfolded or replaced map, or its rejection, with the steps that report the cost and the remaining folds.
PatchMap with_unfolded(const SolveTask& task, PatchMap map, UnfoldedMap&& unfolded);

/// Stage: unfolds the map, or embeds the patch if it has no map, if SolveOptions::fold_free requests it. With hard pins
/// or linear constraints there is no embedding, and their vertices stay.
PatchMap unfolded(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
