#pragma once

#include <vector>

#include "packing/island_raster.h"
#include "packing/packing.h"
#include "packing/packing_grid.h"

namespace spectral_conformal {

/// Islands on the cells of a grid, none overlapping another.
struct GridLayout {
  double scale = 0;                          ///< of the rasters
  std::vector<const IslandRaster*> rasters;  ///< of each island; null if it has no room
  std::vector<CellPosition> at;
};

/// Cells of the finer grid along one of the coarse; the loss to rasters falls by this factor.
constexpr int refinement = 4;

/// Settling gains less than this factor: two cells of an island's width.
constexpr double max_settled_growth = 1 + 2 / cells_per_island;

/// The islands where they lie in the layout.
Packing on_cells(const PackingGrid& grid, const GridLayout& layout);

/// The layout after all islands have settled toward the lower left corner on the finer grid, from below, at the largest
/// scale with room up to `precision`; without `scales`, at the scale of the layout.
Packing settled(const PackingProblem& problem, const PackingGrid& grid, const PackingGrid& fine,
                const GridLayout& layout, bool scales, double precision);

}  // namespace spectral_conformal
