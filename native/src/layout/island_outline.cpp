#include "layout/island_outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "concurrency/listening.h"
#include "geometry/bounding_rectangles.h"
#include "geometry/signed_area.h"

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

std::vector<IslandOutline> island_outlines(const ComplexVector& points, const std::vector<int>& face_offsets,
                                           const std::vector<int>& corners, const std::vector<int>& island_of_face,
                                           int n) {
  std::vector<IslandOutline> outlines(static_cast<std::size_t>(n));
  std::vector<FaceEdge> edges;
  edges.reserve(corners.size());
  for_each_heard(island_of_face.size(), [&](std::size_t f) {
    const int island = island_of_face[f];
    if (island < 0 || island >= n) return;
    const int* const corner = corners.data() + face_offsets[f];
    const int count = face_offsets[f + 1] - face_offsets[f];
    const double area = twice_area(points, corner, count);
    outlines[static_cast<std::size_t>(island)].area += 0.5 * std::abs(area);
    for (int k = 0; k < count; ++k) {
      const int a = corner[k];
      const int b = corner[(k + 1) % count];
      // An island that is a single point still needs an edge.
      if (a == b && count > 1) continue;
      edges.push_back({island, std::min(a, b), std::max(a, b), (a < b) == (area >= 0) ? 1 : -1});
    }
  });
  std::sort(edges.begin(), edges.end(), [](const FaceEdge& a, const FaceEdge& b) {
    return std::tie(a.island, a.low, a.high) < std::tie(b.island, b.low, b.high);
  });
  for (std::size_t i = 0; i < edges.size();) {
    const FaceEdge& edge = edges[i];
    std::size_t end = i;
    int winding = 0;
    for (; end < edges.size() &&
           std::tie(edges[end].island, edges[end].low, edges[end].high) == std::tie(edge.island, edge.low, edge.high);
         ++end) {
      winding += edges[end].direction;
    }
    Complex from = points[edge.low];
    Complex to = points[edge.high];
    if (winding < 0) std::swap(from, to);
    auto& kept = outlines[static_cast<std::size_t>(edge.island)].edges;
    // A collapsed face encloses nothing, but it takes up space.
    const int copies = from == to ? 1 : std::abs(winding);
    for (int k = 0; k < copies; ++k) kept.push_back({from, to});
    still_working(element_nanoseconds * static_cast<double>(end - i));
    i = end;
  }
  // Faces without area may cancel to nothing; their points still count.
  for (std::size_t i = 0; i < edges.size(); ++i) {
    IslandOutline& outline = outlines[static_cast<std::size_t>(edges[i].island)];
    if (!outline.edges.empty() && outline.area > 0) continue;
    outline.edges.push_back({points[edges[i].low], points[edges[i].high]});
    outline.edges.push_back({points[edges[i].high], points[edges[i].low]});
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
