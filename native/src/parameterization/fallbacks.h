#pragma once

#include "parameterization/patch_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Stage: where Method::spectral gave no map, takes the best of several candidates: fewest flipped triangles first,
/// then least mean QC. Candidates are
///  - the rejected map, if any, with its flipped triangles unfolded, or else a relaxed embedding (fold_free_map.h),
///  - the accepted maps of the energy with thin triangles clamped, of the form B with the other measure, and of the
///    energy with the other weights.
/// The first candidate ignores soft pins and a failed blend of the metric: with these, the other problems come first.
/// The map stays rejected if no candidate is found.
PatchMap replaced(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
