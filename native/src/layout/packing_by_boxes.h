#pragma once

#include "layout/packing.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal {

/// The islands packed by their bounding boxes (pack_boxes), as they lie or, if they may turn, on their long side,
/// whichever is denser. Only for problems of one region, without obstacles, where islands are scaled; otherwise, or if
/// the margin leaves no room, the packing's scale is 0. Small islands that are nearly boxes lose less so than to
/// rasters.
Packing packing_by_boxes(const PackingProblem& problem, const PackingOptions& options);

}  // namespace spectral_conformal
