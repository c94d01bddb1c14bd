#include "mesh/hole_filling.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/polygon_normal.h"
#include "geometry/polygon_triangulation.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

using Vector = Eigen::Vector3d;

bool star_shaped(const Positions& corners, const Vector& center) {
  const auto spoke = [&](Eigen::Index i) -> Vector { return corners.row(i % corners.rows()).transpose() - center; };
  const Vector normal = polygon_normal(corners, center);
  // A much smaller spoke triangle than the mean would be a needle in the energy.
  const double min_area = single_rounding * normal.squaredNorm() / static_cast<double>(corners.rows());
  for (Eigen::Index i = 0; i < corners.rows(); ++i) {
    if (!(spoke(i).cross(spoke(i + 1)).dot(normal) > min_area)) return false;
  }
  return true;
}

}  // namespace

HoleFilling fill_holes(const std::vector<BoundaryLoop>& loops, int outer,
                       const Eigen::Ref<const Positions>& positions) {
  HoleFilling result;
  std::vector<Vector> centers;
  PolygonTriangulation polygon;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (static_cast<int>(k) == outer || loops[k].size() < 3) continue;
    // The chart lies to the left of its loops, the hole to the right.
    const BoundaryLoop loop(loops[k].rbegin(), loops[k].rend());
    const auto n = static_cast<Eigen::Index>(loop.size());
    Positions corners(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) corners.row(i) = positions.row(loop[static_cast<std::size_t>(i)]);
    const Vector center = corners.colwise().mean().transpose();
    if (n > 4 && star_shaped(corners, center)) {
      const int apex = static_cast<int>(positions.rows()) + static_cast<int>(centers.size());
      centers.push_back(center);
      for (std::size_t i = 0; i < loop.size(); ++i) {
        result.triangles.push_back({apex, loop[i], loop[(i + 1) % loop.size()]});
        result.triangle_weights.push_back(whole_triangle);
      }
      continue;
    }
    triangulate_polygon(corners, polygon);
    for (std::size_t t = 0; t < polygon.triangles.size(); ++t) {
      const auto& [a, b, c] = polygon.triangles[t];
      result.triangles.push_back(
          {loop[static_cast<std::size_t>(a)], loop[static_cast<std::size_t>(b)], loop[static_cast<std::size_t>(c)]});
      result.triangle_weights.push_back(polygon.triangle_weights[t]);
    }
  }
  result.centers.resize(static_cast<Eigen::Index>(centers.size()), 3);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    result.centers.row(static_cast<Eigen::Index>(i)) = centers[i].transpose();
  }
  return result;
}

}  // namespace spectral_conformal
