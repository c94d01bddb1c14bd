#include "layout/island_raster.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/plane_box.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {

int floor_of_log2(int n) {
  int k = 0;
  while (n >> (k + 1)) ++k;
  return k;
}

IslandRaster::IslandRaster(const IslandOutline& outline, Complex factor, double border) : factor_(factor) {
  if (outline.edges.empty()) return;
  PlaneBox box;
  for (const OutlineEdge& edge : outline.edges) {
    box.include(factor * edge.from);
    box.include(factor * edge.to);
  }
  // Rounding must not reach into the cells below zero.
  const double space = border + single_rounding;
  origin_ = Complex(space, space) - box.low_corner();
  height_ = static_cast<int>(std::floor(box.size().imag() + 2 * space)) + 1;
  spans_ = cell_spans(outline.edges, factor, origin_, border, height_);
  std::vector<CellSpan> by_length = spans_;
  std::sort(by_length.begin(), by_length.end(), [](const CellSpan& a, const CellSpan& b) {
    return std::tuple(b.end - b.begin, a.row, a.begin) < std::tuple(a.end - a.begin, b.row, b.begin);
  });
  longest_first_.reserve(by_length.size());
  for (const CellSpan& span : by_length) {
    width_ = std::max(width_, span.end);
    const int level = floor_of_log2(span.end - span.begin);
    longest_first_.push_back({span.row, level, span.begin, span.end - (1 << level)});
  }
}

bool IslandRaster::has_same_cells(const IslandRaster& other) const {
  return width_ == other.width_ && height_ == other.height_ && spans_ == other.spans_;
}

}  // namespace spectral_conformal
