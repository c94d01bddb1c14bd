#include "packing/overlapping_islands.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "concurrency/cancellation_scope.h"
#include "geometry/box_tree.h"
#include "geometry/plane_triangle.h"
#include "geometry/polygon_triangulation.h"
#include "graph/disjoint_sets.h"
#include "quality/overlap.h"

namespace spectral_conformal {
namespace {

/// The triangles of all islands.
struct TrianglesOfIslands {
  std::vector<PlaneTriangle> placed;
  std::vector<PlaneBox> boxes;
  std::vector<int> islands;

  void add(const std::array<Complex, 3>& corners, int island) {
    placed.emplace_back(corners);
    boxes.push_back(PlaneBox::of({corners[0], corners[1], corners[2]}));
    islands.push_back(island);
  }
};

TrianglesOfIslands triangles_of(const ComplexVector& points, const std::vector<int>& face_offsets,
                                const std::vector<int>& corners, const std::vector<int>& island_of_face, int n) {
  TrianglesOfIslands result;
  for_each_polled(island_of_face.size(), [&](std::size_t f) {
    const int island = island_of_face[f];
    if (island < 0 || island >= n) return;
    const int* const corner = corners.data() + face_offsets[f];
    const int count = face_offsets[f + 1] - face_offsets[f];
    if (count == 3) {
      result.add({points[corner[0]], points[corner[1]], points[corner[2]]}, island);
      return;
    }
    Positions flat = Positions::Zero(count, 3);
    for (int k = 0; k < count; ++k) flat.row(k) << points[corner[k]].real(), points[corner[k]].imag(), 0;
    PolygonTriangulation polygon;
    if (count > 3) triangulate_polygon(flat, polygon);
    for (const auto& [a, b, c] : polygon.triangles) {
      result.add({points[corner[a]], points[corner[b]], points[corner[c]]}, island);
    }
  });
  return result;
}

}  // namespace

std::vector<int> overlapping_islands(const ComplexVector& points, const std::vector<int>& face_offsets,
                                     const std::vector<int>& corners, const std::vector<int>& island_of_face, int n) {
  const TrianglesOfIslands triangles = triangles_of(points, face_offsets, corners, island_of_face, n);
  const BoxTree tree = BoxTree::over(triangles.boxes);
  DisjointSets groups(n);
  for (std::size_t t = 0; t < triangles.placed.size(); ++t) {
    int met = 1;
    tree.for_each_meeting(triangles.boxes[t], [&](int k) {
      const auto other = static_cast<std::size_t>(k);
      ++met;
      // Islands that are in one group already need no test.
      if (other < t && groups.find(triangles.islands[t]) != groups.find(triangles.islands[other]) &&
          overlap_in_map(triangles.placed[t], triangles.placed[other], stored_resolution)) {
        groups.unite(triangles.islands[t], triangles.islands[other]);
      }
      return true;
    });
    poll(met);
  }
  std::vector<int> result(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) result[static_cast<std::size_t>(i)] = groups.find(i);
  return result;
}

}  // namespace spectral_conformal
