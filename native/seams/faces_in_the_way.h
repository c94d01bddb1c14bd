#pragma once

#include <vector>

#include "seams/separating_cut.h"
#include "seams/trial_map.h"

namespace spectral_conformal {

/// A small subset of a chart's defective faces without which its map has no flips or overlaps: the flipped faces, and
/// of connected parts of the others, largest first, those that lie on faces before them. Indices into the chart's
/// faces, ascending. faces: all of the chart, in its order. defective: see defective_faces.
std::vector<int> faces_in_the_way(const SeparableFaces& faces, const TrialMap& mapped,
                                  const std::vector<int>& defective);

}  // namespace spectral_conformal
