#pragma once

#include "packing/packing.h"
#include "packing/packing_grid.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal {

/// The islands where they lie, at `unit` times their points or slightly smaller, if that scale exceeds `least_scale`
/// and respects margin, regions and obstacles to a hundredth of a pixel. Otherwise no packing. On the grid of an
/// earlier packing, its islands respect the margin.
Packing packing_as_given(const PackingProblem& problem, const PackingOptions& options, const PackingGrid& grid,
                         double unit, double least_scale);

}  // namespace spectral_conformal
