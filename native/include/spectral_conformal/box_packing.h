#pragma once

#include <vector>

namespace spectral_conformal {

/// A box with sides parallel to the axes.
struct PackedBox {
  double x = 0;  ///< of the lower left corner
  double y = 0;
  double width = 0;
  double height = 0;
};

/// Moves boxes so that none overlaps another, into a square [0, side]^2 as small as some tries find. Boxes are neither
/// turned nor scaled; widths and heights must be finite and not negative. Returns the side.
///
/// Skyline packing, lowest place first (Jylanki, "A Thousand Ways to Pack the Bin", 2010, section 4), of the boxes from
/// high to low, in strips of several widths. n log n for many boxes (skyline.h).
double pack_boxes(std::vector<PackedBox>& boxes);

}  // namespace spectral_conformal
