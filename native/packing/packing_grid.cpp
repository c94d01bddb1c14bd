#include "packing/packing_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "packing/cell_spans.h"

namespace spectral_conformal {
namespace {

/// Whole cells in this many pixels; rounding must not lose one.
int whole_cells(double pixels, double cells_per_pixel) {
  return std::max(0, static_cast<int>(std::floor(pixels * cells_per_pixel + 1e-9)));
}

std::vector<PackingGrid::Band> bands_of(const std::vector<PackingRegion>& regions, double margin,
                                        double cells_per_pixel) {
  std::vector<PackingGrid::Band> bands;
  int bottom = 0;
  for (const PackingRegion& region : regions) {
    const Complex size = region.high - region.low;
    PackingGrid::Band band;
    band.bottom = bottom;
    band.top = bottom + whole_cells(size.imag() - margin, cells_per_pixel);
    band.width = whole_cells(size.real() - margin, cells_per_pixel);
    band.origin = region.low + 0.5 * margin * Complex(1, 1);
    bands.push_back(band);
    bottom = band.top + 1;
  }
  return bands;
}

int width_of(const std::vector<PackingGrid::Band>& bands) {
  int width = 0;
  for (const PackingGrid::Band& band : bands) width = std::max(width, band.width);
  return width;
}

}  // namespace

PackingGrid::PackingGrid(const std::vector<PackingRegion>& regions, double margin, const IslandOutline& obstacles,
                         double cells_per_pixel)
    : cells_per_pixel_(cells_per_pixel),
      margin_(margin),
      bands_(bands_of(regions, margin, cells_per_pixel)),
      space_(width_of(bands_), bands_.back().top) {
  for (const Band& band : bands_) {
    for (int row = band.bottom; row < band.top; ++row) space_.occupy({{row, band.width, space_.width()}}, {});
    if (band.top < space_.height()) space_.occupy({{band.top, 0, space_.width()}}, {});
    if (obstacles.edges.empty()) continue;
    std::vector<CellSpan> spans =
        cell_spans(obstacles.edges, cells_per_pixel, -cells_per_pixel * band.origin, border(), band.top - band.bottom);
    space_.occupy(spans, {0, band.bottom});
  }
}

int PackingGrid::band_of_row(int row) const {
  std::size_t band = 0;
  while (band + 1 < bands_.size() && bands_[band].top <= row) ++band;
  return static_cast<int>(band);
}

Complex PackingGrid::cells(Complex pixels) const {
  Complex best = 0;
  double least = infinity;
  for (const Band& band : bands_) {
    const Complex z = cells_per_pixel_ * (pixels - band.origin);
    const double height = band.top - band.bottom;
    const Complex inside(std::clamp(z.real(), 0.0, double(band.width)), std::clamp(z.imag(), 0.0, height));
    const double away = std::norm(z - inside);
    if (away >= least) continue;
    least = away;
    best = inside + Complex(0, band.bottom);
  }
  return best;
}

}  // namespace spectral_conformal
