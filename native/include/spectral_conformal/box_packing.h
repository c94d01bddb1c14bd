#pragma once

#include <vector>

namespace spectral_conformal {

/// An axis-aligned box.
struct PackedBox {
  double x = 0;  ///< of the lower left corner
  double y = 0;
  double width = 0;
  double height = 0;
};

/// Moves boxes without overlap into a square [0, side]^2, the smallest of several tries, and returns the side. Boxes
/// are neither rotated nor scaled; widths and heights must be finite and nonnegative.
///
/// Skyline packing, lowest position first (Jylanki, "A Thousand Ways to Pack the Bin", 2010, section 4), and packing
/// onto shelves, from the highest box to the lowest, in strips of several widths. O(n log n) (skyline.h, shelves.h).
double pack_boxes(std::vector<PackedBox>& boxes);

}  // namespace spectral_conformal
