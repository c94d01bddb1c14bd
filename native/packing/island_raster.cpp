#include "packing/island_raster.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/plane_box.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {

IslandRaster IslandRaster::of(const IslandOutline& outline, Complex factor, double border) {
  IslandRaster raster;
  raster.factor_ = factor;
  if (outline.edges.empty()) return raster;
  PlaneBox box;
  for (const OutlineEdge& edge : outline.edges) {
    box.include(factor * edge.from);
    box.include(factor * edge.to);
  }
  // Rounding must not reach into the cells below zero.
  const double space = border + single_rounding;
  raster.origin_ = Complex(space, space) - box.low_corner();
  raster.height_ = static_cast<int>(std::floor(box.size().imag() + 2 * space)) + 1;
  raster.spans_ = cell_spans(outline.edges, factor, raster.origin_, border, raster.height_);
  std::vector<CellSpan> by_length = raster.spans_;
  std::sort(by_length.begin(), by_length.end(), [](const CellSpan& a, const CellSpan& b) {
    return std::tuple(b.end - b.begin, a.row, a.begin) < std::tuple(a.end - a.begin, b.row, b.begin);
  });
  raster.longest_first_.reserve(by_length.size());
  for (const CellSpan& span : by_length) {
    raster.width_ = std::max(raster.width_, span.end);
    const int level = std::ilogb(span.end - span.begin);
    raster.longest_first_.push_back({span.row, level, span.begin, span.end - (1 << level)});
  }
  return raster;
}

bool IslandRaster::has_same_cells(const IslandRaster& other) const {
  return width_ == other.width_ && height_ == other.height_ && spans_ == other.spans_;
}

}  // namespace spectral_conformal
