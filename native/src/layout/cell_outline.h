#pragma once

#include "layout/island_outline.h"

namespace spectral_conformal {

/// The outline without its inner edges, where it has many: those of faces that lie on each other do not cancel, and
/// every raster would visit them. In their place comes the border of all cells that the outline touches, some hundreds
/// along its bounding box, which covers a little more. The area stays.
IslandOutline without_inner_edges(IslandOutline outline);

}  // namespace spectral_conformal
