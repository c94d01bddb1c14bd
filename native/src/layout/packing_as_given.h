#pragma once

#include "layout/packing.h"
#include "layout/packing_grid.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal {

/// The islands where they are, which is at `unit` times their points, at most a little smaller, if that is larger than
/// `least_scale` and keeps margin, regions and obstacles to a hundredth of a pixel. Otherwise none. On the grid of an
/// earlier packing, all its islands are found to keep the margin.
Packing packing_as_given(const PackingProblem& problem, const PackingOptions& options, const PackingGrid& grid,
                         double unit, double least_scale);

}  // namespace spectral_conformal
