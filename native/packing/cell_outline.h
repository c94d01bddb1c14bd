#pragma once

#include "layout/island_outline.h"

namespace spectral_conformal {

/// The outline without its inner edges if it has many: those of overlapping faces do not cancel, and every raster would
/// visit them. The border of all cells that the outline touches, some hundreds along its bounding box, replaces it and
/// covers a little more. The area stays the same. n: of how many stacked outlines it consists, each of which counts on
/// its own.
IslandOutline without_inner_edges(IslandOutline outline, int n = 1);

}  // namespace spectral_conformal
