#pragma once

#include <vector>

#include "layout/island_outline.h"
#include "packing/free_space.h"
#include "spectral_conformal/island_packing.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The regions as one grid of cells: each region is a band of rows, from below, with a taken row between two bands.
/// Cells cover the part of a region at least half a margin from its border, so rasters that include half a margin keep
/// a whole one.
class PackingGrid {
 public:
  /// cells_per_pixel: resolution. Obstacles are in pixels.
  PackingGrid(const std::vector<PackingRegion>& regions, double margin, const IslandOutline& obstacles,
              double cells_per_pixel);

  double cells_per_pixel() const { return cells_per_pixel_; }
  /// Half of the margin, in cells.
  double border() const { return 0.5 * margin_ * cells_per_pixel_; }
  /// Free except for the obstacles.
  const FreeSpace& space() const { return space_; }

  struct Band {
    int bottom = 0;  ///< row
    int top = 0;     ///< row above the last
    int width = 0;
    Complex origin;  ///< in pixels: the lower left corner of the band's first cell
  };
  const std::vector<Band>& bands() const { return bands_; }
  int band_of_row(int row) const;
  /// The position in pixels of a point in cells.
  Complex pixels(Complex cells, int band) const {
    const Band& b = bands_[static_cast<std::size_t>(band)];
    return b.origin + (cells - Complex(0, b.bottom)) / cells_per_pixel_;
  }

  /// The position in cells of a point in pixels, in the first region that holds it, or else in the nearest one.
  Complex cells(Complex pixels) const;

 private:
  double cells_per_pixel_;
  double margin_;
  std::vector<Band> bands_;
  FreeSpace space_;
};

}  // namespace spectral_conformal
