#include "packing/cell_outline.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/plane_box.h"
#include "packing/island_raster.h"

namespace spectral_conformal {
namespace {

/// An end of a span in one of two neighboring rows.
struct SpanEnd {
  int x;
  bool is_upper;
  int change;  ///< 1 where the span begins, -1 where it ends
};

double length_of(const std::vector<OutlineEdge>& edges) {
  double length = 0;
  for (const OutlineEdge& edge : edges) length += std::abs(edge.to - edge.from);
  return length;
}

/// The edges around the cells, counterclockwise.
std::vector<OutlineEdge> border_of(const std::vector<CellSpan>& spans, int n_rows) {
  std::vector<OutlineEdge> edges;
  auto lower = spans.begin();
  auto upper = spans.begin();
  std::vector<SpanEnd> ends;
  for (int y = 0; y <= n_rows; ++y) {
    ends.clear();
    for (; lower != upper; ++lower) {
      ends.push_back({lower->begin, false, 1});
      ends.push_back({lower->end, false, -1});
    }
    for (; upper != spans.end() && upper->row == y; ++upper) {
      ends.push_back({upper->begin, true, 1});
      ends.push_back({upper->end, true, -1});
      edges.push_back({Complex(upper->end, y), Complex(upper->end, y + 1)});
      edges.push_back({Complex(upper->begin, y + 1), Complex(upper->begin, y)});
    }
    std::sort(ends.begin(), ends.end(), [](const SpanEnd& a, const SpanEnd& b) { return a.x < b.x; });
    int above = 0;
    int below = 0;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      (ends[k].is_upper ? above : below) += ends[k].change;
      const Complex left(ends[k].x, y);
      const Complex right(ends[k + 1].x, y);
      if (left == right || above == below) continue;
      edges.push_back(above > below ? OutlineEdge{left, right} : OutlineEdge{right, left});
    }
  }
  return edges;
}

}  // namespace

IslandOutline without_inner_edges(IslandOutline outline, int n) {
  // A border of cells is no longer exact, and its steps are longer than a curve by up to sqrt(2): it pays only for
  // outlines that are much longer, as those of crossing sheets; those of stacked islands stay.
  constexpr double gain = 4;
  const double length = length_of(outline.edges) / n;
  PlaneBox box;
  for (const OutlineEdge& edge : outline.edges) box.include(edge.from);
  // The hull goes from one side of the box to the other and back.
  if (!(length > gain * 2 * std::abs(box.size()))) return outline;
  const std::vector<Complex> hull = hull_of(outline);
  double perimeter = 0;
  for (std::size_t k = 0; k < hull.size(); ++k) perimeter += std::abs(hull[(k + 1) % hull.size()] - hull[k]);
  // No border is shorter than its hull.
  if (!(length > gain * perimeter)) return outline;
  const Complex size = PlaneBox::of(hull).size();
  const double factor = cells_across / std::max(size.real(), size.imag());
  const IslandRaster raster = IslandRaster::of(outline, factor, 0);
  std::vector<OutlineEdge> border = border_of(raster.spans(), raster.height());
  if (!(length * factor > gain * length_of(border))) return outline;
  for (OutlineEdge& edge : border) {
    edge.from = (edge.from - raster.origin()) / factor;
    edge.to = (edge.to - raster.origin()) / factor;
  }
  outline.edges = std::move(border);
  return outline;
}

}  // namespace spectral_conformal
