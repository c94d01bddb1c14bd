#pragma once

#include "packing/packing.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal {

/// The islands packed by their bounding boxes (pack_boxes), as given or, if they may turn, on their long sides,
/// whichever is denser. Only for problems with one region, without obstacles, in which islands are scaled; otherwise,
/// or if the margin leaves no room, the packing's scale is 0. Small islands that are nearly boxes lose less in this way
/// than by rasters. is_quick: with fewer tries.
Packing packing_by_boxes(const PackingProblem& problem, const PackingOptions& options, bool is_quick = false);

/// The scale that no packing by boxes exceeds, since they would have a larger area than the region; 0 where
/// packing_by_boxes has none.
double largest_scale_of_boxes(const PackingProblem& problem, const PackingOptions& options);

}  // namespace spectral_conformal
