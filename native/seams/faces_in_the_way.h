#pragma once

#include <vector>

#include "seams/separating_cut.h"
#include "seams/trial_map.h"

namespace spectral_conformal {

/// Few of the defective faces of a chart (as of defective_faces), without which the others neither overlap nor are
/// flipped in its map: those that are flipped, and of parts that lie on each other the smaller ones. Ascending; `faces`
/// are those of the chart, in its order.
std::vector<int> faces_in_the_way(const SeparableFaces& faces, const TrialMap& mapped,
                                  const std::vector<int>& defective);

}  // namespace spectral_conformal
