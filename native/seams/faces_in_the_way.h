#pragma once

#include <vector>

#include "seams/separating_cut.h"
#include "seams/trial_map.h"

namespace spectral_conformal {

/// A small subset of the defective faces of a chart (see defective_faces) without which its map has no flips and
/// overlaps: the flipped faces, and the smaller of two overlapping parts. Ascending; faces: those of the chart, in its
/// order.
std::vector<int> faces_in_the_way(const SeparableFaces& faces, const TrialMap& mapped,
                                  const std::vector<int>& defective);

}  // namespace spectral_conformal
