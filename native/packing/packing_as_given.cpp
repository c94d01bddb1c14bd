#include "packing/packing_as_given.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "geometry/plane_box.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "packing/cell_spans.h"
#include "packing/settling.h"

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

constexpr int obstacles = -1;

/// Cells of an island, or of the `obstacles`.
struct OwnedSpan {
  CellSpan span;
  int owner;
};

/// The owners of common cells, each pair once.
std::set<std::pair<int, int>> overlapping(std::vector<OwnedSpan>& spans) {
  std::sort(spans.begin(), spans.end(), [](const OwnedSpan& a, const OwnedSpan& b) {
    return std::tie(a.span.row, a.span.begin, a.owner) < std::tie(b.span.row, b.span.begin, b.owner);
  });
  std::set<std::pair<int, int>> pairs;
  std::vector<OwnedSpan> open;
  for (const OwnedSpan& each : spans) {
    const auto is_past = [&](const OwnedSpan& other) {
      return other.span.row != each.span.row || other.span.end <= each.span.begin;
    };
    open.erase(std::remove_if(open.begin(), open.end(), is_past), open.end());
    for (const OwnedSpan& other : open) pairs.insert(std::minmax(other.owner, each.owner));
    open.push_back(each);
  }
  return pairs;
}

bool crosses(const OutlineEdge& one, const OutlineEdge& two) {
  const auto is_parted = [](const OutlineEdge& line, const OutlineEdge& ends) {
    const Complex along = line.to - line.from;
    return (cross(along, ends.from - line.from) < 0) != (cross(along, ends.to - line.from) < 0);
  };
  return is_parted(one, two) && is_parted(two, one);
}

bool covers(const IslandOutline& outline, Complex p) {
  int winding = 0;
  for (const OutlineEdge& edge : outline.edges) {
    const bool is_up = edge.from.imag() <= p.imag();
    if (is_up == (edge.to.imag() <= p.imag())) continue;
    if ((cross(edge.to - edge.from, p - edge.from) > 0) == is_up) winding += is_up ? 1 : -1;
  }
  return winding != 0;
}

/// Whether no point of one is nearer to the other than the distance. box: of the first.
bool are_apart(const IslandOutline& one, const PlaneBox& box, const IslandOutline& two, double distance) {
  const Complex low = box.low_corner() - distance * Complex(1, 1);
  const Complex high = box.low_corner() + box.size() + distance * Complex(1, 1);
  for (const OutlineEdge& b : two.edges) {
    if (std::max(b.from.real(), b.to.real()) < low.real() || std::min(b.from.real(), b.to.real()) > high.real() ||
        std::max(b.from.imag(), b.to.imag()) < low.imag() || std::min(b.from.imag(), b.to.imag()) > high.imag()) {
      continue;
    }
    for (const OutlineEdge& a : one.edges) {
      const double square = std::min({squared_distance(a.from, b), squared_distance(a.to, b),
                                      squared_distance(b.from, a), squared_distance(b.to, a)});
      if (square < distance * distance || crosses(a, b)) return false;
    }
    poll(one.edges.size());
  }
  return !covers(two, one.edges.front().from) && !covers(one, two.edges.front().from);
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
      std::vector<OwnedSpan> spans;
      const auto add = [&](const std::vector<CellSpan>& own, int owner) {
        for (const CellSpan& span : own) spans.push_back({span, owner});
      };
      add(cell_spans(problem.obstacles.edges, cells, -cells * band.origin, border, n_rows), obstacles);
      for (const std::size_t i : inside[r]) {
        const Complex offset = (1 - growth) * boxes[i].middle() - band.origin;
        add(cell_spans(problem.islands[i].edges, cells * growth * unit, cells * offset, border, n_rows),
            static_cast<int>(i));
      }
      // Rasters reach up to a cell farther. Islands that cannot get smaller are measured.
      for (const auto& [a, b] : overlapping(spans)) {
        if (options.scales || unit != 1) return false;
        const IslandOutline& one = problem.islands[static_cast<std::size_t>(b)];
        const IslandOutline& two = a == obstacles ? problem.obstacles : problem.islands[static_cast<std::size_t>(a)];
        if (!are_apart(one, boxes[static_cast<std::size_t>(b)], two, options.margin - slack)) return false;
      }
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
