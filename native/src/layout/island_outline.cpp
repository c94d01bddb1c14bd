#include "layout/island_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/signed_area.h"
#include "mesh/edge_table.h"

namespace spectral_conformal {
namespace {

/// A side of a face of an island.
struct Side {
  int island;
  int direction;  ///< 1 from the lower to the higher index of its ends, -1 back
  bool operator<(const Side& other) const { return island < other.island; }
};

/// Twice the signed area, relative to the first corner, which keeps the digits of a small face far from the origin.
double twice_area(const ComplexVector& points, const int* corner, int n) {
  double sum = 0;
  for (int k = 1; k + 1 < n; ++k) {
    sum += cross(points[corner[k]] - points[corner[0]], points[corner[k + 1]] - points[corner[0]]);
  }
  return sum;
}

}  // namespace

double squared_distance(Complex p, const OutlineEdge& edge) {
  const Complex along = edge.to - edge.from;
  const double square = std::norm(along);
  const double t = square > 0 ? std::clamp(dot(p - edge.from, along) / square, 0.0, 1.0) : 0.0;
  return std::norm(p - edge.from - t * along);
}

std::vector<IslandOutline> island_outlines(const ComplexVector& points, const std::vector<int>& face_offsets,
                                           const std::vector<int>& corners, const std::vector<int>& island_of_face,
                                           int n) {
  std::vector<IslandOutline> outlines(static_cast<std::size_t>(n));
  std::vector<std::pair<std::array<int, 2>, Side>> sides;
  sides.reserve(corners.size());
  for_each_polled(island_of_face.size(), [&](std::size_t f) {
    const int island = island_of_face[f];
    if (island < 0 || island >= n) return;
    const int* const corner = corners.data() + face_offsets[f];
    const int count = face_offsets[f + 1] - face_offsets[f];
    const double area = twice_area(points, corner, count);
    outlines[static_cast<std::size_t>(island)].area += 0.5 * std::abs(area);
    const std::size_t before = sides.size();
    for (int k = 0; k < count; ++k) {
      const int a = corner[k];
      const int b = corner[k + 1 < count ? k + 1 : 0];
      // An island that is a single point still needs an edge.
      if (a == b && (k + 1 < count || sides.size() > before)) continue;
      sides.push_back({{a, b}, {island, (a < b) == (area >= 0) ? 1 : -1}});
    }
  });
  count_steps(static_cast<double>(sides.size()));
  const EdgeTable<Side> table(static_cast<int>(points.size()), [&](const auto& visit) {
    for_each_polled(sides.size(), [&](std::size_t i) { visit(sides[i].first[0], sides[i].first[1], sides[i].second); });
  });
  table.for_each_edge([&](const std::array<int, 2>& ends, const auto* first, const auto* last) {
    while (first != last) {
      const int island = first->value.island;
      int winding = 0;
      for (; first != last && first->value.island == island; ++first) winding += first->value.direction;
      Complex from = points[ends[0]];
      Complex to = points[ends[1]];
      if (winding < 0) std::swap(from, to);
      auto& kept = outlines[static_cast<std::size_t>(island)].edges;
      // A collapsed face encloses nothing, but it takes up space.
      const int copies = from == to ? 1 : std::abs(winding);
      for (int k = 0; k < copies; ++k) kept.push_back({from, to});
    }
  });
  // Faces without area may cancel to nothing; their points still count.
  const auto is_complete = [](const IslandOutline& outline) { return !outline.edges.empty() && outline.area > 0; };
  if (std::all_of(outlines.begin(), outlines.end(), is_complete)) return outlines;
  table.for_each_edge([&](const std::array<int, 2>& ends, const auto* first, const auto* last) {
    for (; first != last; ++first) {
      IslandOutline& outline = outlines[static_cast<std::size_t>(first->value.island)];
      if (is_complete(outline)) continue;
      outline.edges.push_back({points[ends[0]], points[ends[1]]});
      outline.edges.push_back({points[ends[1]], points[ends[0]]});
    }
  });
  return outlines;
}

void add(IslandOutline& outline, const IslandOutline& other, const PlaneMotion& motion) {
  outline.edges.reserve(outline.edges.size() + other.edges.size());
  for (const OutlineEdge& edge : other.edges) {
    OutlineEdge moved{motion(edge.from), motion(edge.to)};
    if (motion.mirrors) std::swap(moved.from, moved.to);
    outline.edges.push_back(moved);
  }
}

std::vector<Complex> hull_of(const IslandOutline& outline) {
  std::vector<Complex> points;
  points.reserve(2 * outline.edges.size());
  for (const OutlineEdge& edge : outline.edges) {
    points.push_back(edge.from);
    points.push_back(edge.to);
  }
  return convex_hull(std::move(points));
}

bool is_rectilinear(double manhattan, double euclidean) { return manhattan < 0.5 * (1 + 4 / pi) * euclidean; }

}  // namespace spectral_conformal
