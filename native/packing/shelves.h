#pragma once

#include <cstddef>
#include <vector>

#include "spectral_conformal/box_packing.h"

namespace spectral_conformal {

/// Packs the boxes onto shelves in a strip [0, width], from below, and sets their x and y. order: the boxes from the
/// highest to the lowest, none wider than the strip. Each goes to the lowest shelf with room (first fit by decreasing
/// height: Coffman, Garey, Johnson and Tarjan, "Performance Bounds for Level-Oriented Two-Dimensional Packing
/// Algorithms", 1980). The heights on a shelf fall to the right and to the left by turns, and each box sinks onto those
/// below it, so many boxes waste little space. O(n log n).
void put_on_shelves(double width, const std::vector<std::size_t>& order, std::vector<PackedBox>& boxes);

}  // namespace spectral_conformal
