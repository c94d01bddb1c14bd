#pragma once

#include <cstddef>
#include <vector>

#include "spectral_conformal/box_packing.h"

namespace spectral_conformal {

/// Sets x and y of the boxes: onto shelves from below in a strip [0, width]. order: the boxes from the highest to the
/// lowest, none wider than the strip. Each goes to the lowest shelf that has room (first fit by decreasing height:
/// Coffman, Garey, Johnson and Tarjan, "Performance Bounds for Level-Oriented Two-Dimensional Packing Algorithms",
/// 1980). Shelves fall from left to right and from right to left by turns, and each box sinks onto those below it, so
/// of many boxes, little is lost. O(n log n).
void put_on_shelves(double width, const std::vector<std::size_t>& order, std::vector<PackedBox>& boxes);

}  // namespace spectral_conformal
