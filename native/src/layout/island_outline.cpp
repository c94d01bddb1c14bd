#include "layout/island_outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/signed_area.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// An edge of a face between two points, stored from the lower to the higher index.
struct FaceEdge {
  int island;
  int low;
  int high;
  int direction;  ///< 1 from low to high, -1 back
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
  std::vector<FaceEdge> edges;
  edges.reserve(corners.size());
  for_each_polled(island_of_face.size(), [&](std::size_t f) {
    const int island = island_of_face[f];
    if (island < 0 || island >= n) return;
    const int* const corner = corners.data() + face_offsets[f];
    const int count = face_offsets[f + 1] - face_offsets[f];
    const double area = twice_area(points, corner, count);
    outlines[static_cast<std::size_t>(island)].area += 0.5 * std::abs(area);
    const std::size_t before = edges.size();
    for (int k = 0; k < count; ++k) {
      const int a = corner[k];
      const int b = corner[k + 1 < count ? k + 1 : 0];
      // An island that is a single point still needs an edge.
      if (a == b && (k + 1 < count || edges.size() > before)) continue;
      edges.push_back({island, std::min(a, b), std::max(a, b), (a < b) == (area >= 0) ? 1 : -1});
    }
  });
  count_steps(static_cast<double>(edges.size()));
  // In the order of their lower points; few share one, so sorting takes linear time.
  Grouped<FaceEdge> by_low(static_cast<int>(points.size()), [&](const auto& visit) {
    for_each_polled(edges.size(), [&](std::size_t i) { visit(edges[i].low, edges[i]); });
  });
  const auto key = [](const FaceEdge& edge) { return std::pair(edge.island, edge.high); };
  for_each_polled(by_low.n_keys(), [&](int low) {
    const auto own = by_low[low];
    std::sort(own.begin(), own.end(), [&](const FaceEdge& a, const FaceEdge& b) { return key(a) < key(b); });
    for (auto edge = own.begin(); edge != own.end();) {
      auto end = edge;
      int winding = 0;
      for (; end != own.end() && key(*end) == key(*edge); ++end) winding += end->direction;
      Complex from = points[edge->low];
      Complex to = points[edge->high];
      if (winding < 0) std::swap(from, to);
      auto& kept = outlines[static_cast<std::size_t>(edge->island)].edges;
      // A collapsed face encloses nothing, but it takes up space.
      const int copies = from == to ? 1 : std::abs(winding);
      for (int k = 0; k < copies; ++k) kept.push_back({from, to});
      edge = end;
    }
  });
  // Faces without area may cancel to nothing; their points still count.
  const auto is_complete = [](const IslandOutline& outline) { return !outline.edges.empty() && outline.area > 0; };
  if (std::all_of(outlines.begin(), outlines.end(), is_complete)) return outlines;
  for (const FaceEdge& edge : by_low.values()) {
    IslandOutline& outline = outlines[static_cast<std::size_t>(edge.island)];
    if (is_complete(outline)) continue;
    outline.edges.push_back({points[edge.low], points[edge.high]});
    outline.edges.push_back({points[edge.high], points[edge.low]});
  }
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
