#include "layout/packing_as_given.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include "geometry/plane_box.h"
#include "geometry/tolerances.h"
#include "layout/cell_spans.h"
#include "layout/settling.h"

namespace spectral_conformal {
namespace {

/// How far the margin may be undercut, in pixels: maps are in single precision.
double slack_of(const std::vector<PackingRegion>& regions) {
  double farthest = 0;
  for (const PackingRegion& region : regions)
    farthest = std::max({farthest, std::abs(region.low), std::abs(region.high)});
  return single_rounding * farthest;
}

/// Whether the box about its middle, scaled by `growth`, is in the region, the margin away from its border.
bool is_inside(const PlaneBox& box, double growth, const PackingRegion& region, double margin) {
  const Complex half = 0.5 * growth * box.size() + margin * Complex(1, 1);
  const Complex low = box.middle() - half - region.low;
  const Complex high = region.high - box.middle() - half;
  return low.real() >= 0 && low.imag() >= 0 && high.real() >= 0 && high.imag() >= 0;
}

bool overlap(std::vector<CellSpan>& spans) {
  std::sort(spans.begin(), spans.end(),
            [](const CellSpan& a, const CellSpan& b) { return std::tie(a.row, a.begin) < std::tie(b.row, b.begin); });
  return std::adjacent_find(spans.begin(), spans.end(), [](const CellSpan& a, const CellSpan& b) {
           return a.row == b.row && b.begin < a.end;
         }) != spans.end();
}

}  // namespace

Packing packing_as_given(const PackingProblem& problem, const PackingOptions& options, const PackingGrid& grid,
                         double unit, double least_scale) {
  const std::size_t n = problem.islands.size();
  std::vector<PlaneBox> boxes(n);
  double area = 0;
  double room = 0;
  for (std::size_t i = 0; i < n; ++i) {
    area += unit * unit * problem.islands[i].area;
    for (const OutlineEdge& edge : problem.islands[i].edges) {
      boxes[i].include(unit * edge.from);
      boxes[i].include(unit * edge.to);
    }
  }
  for (const PackingRegion& region : options.regions) {
    const Complex size = region.high - region.low;
    room += size.real() * size.imag();
  }
  if (area > room) return {};
  const double slack = slack_of(options.regions);
  const auto fits = [&](double growth) {
    std::vector<std::vector<std::size_t>> inside(options.regions.size());
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t at = 0;
      const int own = problem.region[i];
      const auto holds = [&](std::size_t r) {
        return (own < 0 || own == static_cast<int>(r)) &&
               is_inside(boxes[i], growth, options.regions[r], options.margin - slack);
      };
      while (at < inside.size() && !holds(at)) ++at;
      if (at == inside.size()) return false;
      inside[at].push_back(i);
    }
    const double cells = grid.cells_per_pixel();
    const double border = std::max(0.0, grid.border() - 0.5 * slack * cells);
    for (std::size_t r = 0; r < inside.size(); ++r) {
      const PackingGrid::Band& band = grid.bands()[r];
      // One more row, for the part of a cell for which the band has no room.
      const int n_rows = band.top - band.bottom + 1;
      std::vector<CellSpan> spans = cell_spans(problem.obstacles.edges, cells, -cells * band.origin, border, n_rows);
      for (const std::size_t i : inside[r]) {
        const Complex offset = (1 - growth) * boxes[i].middle() - band.origin;
        const auto own = cell_spans(problem.islands[i].edges, cells * growth * unit, cells * offset, border, n_rows);
        spans.insert(spans.end(), own.begin(), own.end());
      }
      if (overlap(spans)) return false;
    }
    return true;
  };
  double longest = 0;
  for (const PlaneBox& box : boxes) {
    const Complex size = grid.cells_per_pixel() * box.size();
    longest = std::max({longest, size.real(), size.imag()});
  }
  // A raster may reach a cell beyond the margin. So islands get smaller, the longest by 1, 2, 4 cells and so on, up to
  // two of the coarse grid. If that is not enough, the margin itself is missing.
  for (double cells = 0; cells <= std::min(longest, 2.0 * refinement); cells = std::max(1.0, 2 * cells)) {
    const double growth = 1 - cells / longest;
    if (!(growth * unit > least_scale)) break;
    if (fits(growth)) {
      Packing packing;
      packing.scale = growth * unit;
      for (const PlaneBox& box : boxes) {
        packing.motions.push_back({growth * unit, false, (1 - growth) * box.middle()});
      }
      packing.has_room.assign(n, true);
      return packing;
    }
    if (!options.scales) break;
  }
  return {};
}

}  // namespace spectral_conformal
