#pragma once

#include "layout/island_outline.h"

namespace spectral_conformal {

/// The outline without its inner edges if it has many: those of overlapping faces do not cancel, and every raster would
/// visit them. The border of all cells that the outline touches, some hundreds along its bounding box, replaces it and
/// covers a little more. The area stays the same.
IslandOutline without_inner_edges(IslandOutline outline);

}  // namespace spectral_conformal
