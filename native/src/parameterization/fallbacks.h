#pragma once

#include "parameterization/patch_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Stage: where a patch has no map by Method::spectral and SolveOptions::fallbacks allows it, the one of least mean QC
/// among those without flipped triangles, or, if all have some, among those with the fewest, of
///   the rejected map itself, where it is there, its flipped triangles unfolded, or else an embedding, relaxed
///   (fold_free_map.h); the accepted maps of the energy with thin triangles clamped, of the form B with the other
///   measure, and of the energy with the other weights.
/// The first knows neither soft pins nor a blend of the metric that failed: with these, the other problems come first.
/// Not where extenders or rigid holes may be what makes the map fail: these are what to change. The map stays rejected
/// where there is none.
PatchMap replaced(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
