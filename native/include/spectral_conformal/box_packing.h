#pragma once

#include <cstddef>
#include <vector>

namespace spectral_conformal {

/// An axis-aligned box.
struct PackedBox {
  double x = 0;  ///< of the lower left corner
  double y = 0;
  double width = 0;
  double height = 0;
};

/// All trials that exchange two boxes together put so many boxes again, which takes a few milliseconds.
constexpr std::size_t all_exchanged_boxes = 50000;
/// For a quick packing.
constexpr std::size_t few_exchanged_boxes = all_exchanged_boxes / 20;

/// Moves boxes without overlap into a square [0, side]^2, the smallest of several tries, and returns the side. Boxes
/// are neither rotated nor scaled; widths and heights must be finite and nonnegative.
///
/// Skyline packing, lowest position first (Jylanki, "A Thousand Ways to Pack the Bin", 2010, section 4), and packing
/// onto shelves, from the highest box to the lowest, in strips of several widths. O(n log n) (skyline.h, shelves.h).
/// Few boxes are also put in other orders and exchanged, of which `exchanged_boxes` limits the work.
double pack_boxes(std::vector<PackedBox>& boxes, std::size_t exchanged_boxes = all_exchanged_boxes);

}  // namespace spectral_conformal
