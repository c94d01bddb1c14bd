#include "geometry/polygon_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/polygon_normal.h"
#include "geometry/quad_splits.h"

namespace spectral_conformal {
namespace {

using Vector = Eigen::Vector3d;

/// The plane's axes e1, e2 with e1 x e2 along `normal`, chosen from the normal alone.
std::pair<Vector, Vector> plane_axes(const Vector& normal) {
  Eigen::Index smallest;
  normal.cwiseAbs().minCoeff(&smallest);
  const Vector first = normal.cross(Vector::Unit(smallest)).normalized();
  return {first, normal.normalized().cross(first)};
}

void triangulate_quad(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result) {
  const auto point = [&](int i) -> Vector { return corners.row(i).transpose(); };
  const Vector normal = (point(2) - point(0)).cross(point(3) - point(1));  // Newell's, in closed form
  // A triangle lies inside when it is oriented like the quad, with an area above this fraction of the quad's: less is
  // rounding of a corner on the diagonal.
  constexpr double min_fraction = 1e-9;
  const auto inside = [&](const std::array<int, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    return (point(b) - point(a)).cross(point(c) - point(a)).dot(normal) > min_fraction * normal.squaredNorm();
  };
  const bool along_02 = inside(quad_splits[0]) && inside(quad_splits[1]);
  const bool along_13 = inside(quad_splits[2]) && inside(quad_splits[3]);
  const bool both = along_02 == along_13;
  if (both || along_02) result.triangles.insert(result.triangles.end(), quad_splits.begin(), quad_splits.begin() + 2);
  if (both || along_13) result.triangles.insert(result.triangles.end(), quad_splits.begin() + 2, quad_splits.end());
  result.triangle_weights.assign(result.triangles.size(), both ? quad_split_weight : 1.0);
  result.simple = along_02 || along_13;
}

struct FaceInfo {
  bool visited = false;
  bool inside = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using ConstrainedDelaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// Marks the faces inside the constraints by crossing parity, from the infinite face inwards.
void mark_inside(ConstrainedDelaunay& triangulation) {
  std::vector<std::pair<ConstrainedDelaunay::Face_handle, bool>> stack{{triangulation.infinite_face(), false}};
  while (!stack.empty()) {
    const auto [face, inside] = stack.back();
    stack.pop_back();
    if (face->info().visited) continue;
    face->info() = {true, inside};
    for (int side = 0; side < 3; ++side) {
      const auto neighbour = face->neighbor(side);
      if (!neighbour->info().visited) stack.emplace_back(neighbour, inside != face->is_constrained(side));
    }
  }
}

/// Returns false when the projected polygon is not simple.
bool constrained_delaunay(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result) {
  const int n = static_cast<int>(corners.rows());
  const Vector centre = corners.colwise().mean().transpose();
  const Vector normal = polygon_normal(corners, centre);
  if (!(normal.squaredNorm() > 0) || !normal.allFinite()) return false;
  const auto [first, second] = plane_axes(normal);

  ConstrainedDelaunay triangulation;
  std::vector<ConstrainedDelaunay::Vertex_handle> handles;
  handles.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const Vector p = corners.row(i).transpose() - centre;
    const auto handle = triangulation.insert(Kernel::Point_2(p.dot(first), p.dot(second)));
    handle->info() = i;
    handles.push_back(handle);
  }
  if (static_cast<int>(triangulation.number_of_vertices()) != n) return false;
  try {
    for (int i = 0; i < n; ++i) triangulation.insert_constraint(handles[i], handles[(i + 1) % n]);
  } catch (const ConstrainedDelaunay::Intersection_of_constraints_exception&) {
    return false;
  }
  mark_inside(triangulation);
  for (const auto& face : triangulation.finite_face_handles()) {
    if (!face->info().inside) continue;
    result.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  // Where an edge passes through another corner, the number of triangles can be right although one has none.
  std::vector<char> is_covered(static_cast<std::size_t>(n), 0);
  for (const auto& triangle : result.triangles) {
    for (const int corner : triangle) is_covered[static_cast<std::size_t>(corner)] = 1;
  }
  const bool covers_all = std::find(is_covered.begin(), is_covered.end(), 0) == is_covered.end();
  if (static_cast<int>(result.triangles.size()) != n - 2 || !covers_all) {
    result.triangles.clear();
    return false;
  }
  return true;
}

void fan(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result) {
  const int n = static_cast<int>(corners.rows());
  Eigen::Index apex;
  (corners.rowwise() - corners.colwise().mean()).rowwise().squaredNorm().minCoeff(&apex);
  const int first = static_cast<int>(apex);
  for (int i = 1; i + 1 < n; ++i) result.triangles.push_back({first, (first + i) % n, (first + i + 1) % n});
}

}  // namespace

void triangulate_polygon(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result) {
  result.triangles.clear();
  result.triangle_weights.clear();
  result.simple = true;
  if (corners.rows() == 3) {
    result.triangles.push_back({0, 1, 2});
    result.triangle_weights.push_back(1.0);
    return;
  }
  if (corners.rows() == 4) {
    triangulate_quad(corners, result);
    return;
  }
  if (!corners.allFinite() || !constrained_delaunay(corners, result)) {
    fan(corners, result);
    result.simple = false;
  }
  result.triangle_weights.assign(result.triangles.size(), 1.0);
}

}  // namespace spectral_conformal
