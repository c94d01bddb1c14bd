#include "geometry/polygon_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "geometry/ear_clipping.h"
#include "geometry/plane_box.h"
#include "geometry/polygon_normal.h"
#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "graph/mixed_bits.h"

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

/// Whether the corners lie on one line, up to rounding.
bool has_no_area(const Eigen::Ref<const Positions>& corners) {
  if (!corners.allFinite()) return false;
  Eigen::Index farthest;
  (corners.rowwise() - corners.row(0)).rowwise().squaredNorm().maxCoeff(&farthest);
  const Vector line = (corners.row(farthest) - corners.row(0)).transpose();
  for (Eigen::Index i = 0; i < corners.rows(); ++i) {
    const Vector p = (corners.row(i) - corners.row(0)).transpose();
    if (line.cross(p).norm() > sum_rounding * line.squaredNorm()) return false;
  }
  return true;
}

void triangulate_quad(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result) {
  const auto point = [&](int i) -> Vector { return corners.row(i).transpose(); };
  const Vector normal = (point(2) - point(0)).cross(point(3) - point(1));  // Newell's, in closed form
  // A triangle lies inside if it is oriented like the quad and has a significant fraction of its area; less is
  // rounding of a corner on the diagonal.
  const auto is_above = [&](const std::array<int, 3>& triangle, double fraction) {
    const auto& [a, b, c] = triangle;
    return (point(b) - point(a)).cross(point(c) - point(a)).dot(normal) > fraction * normal.squaredNorm();
  };
  const auto are_above = [&](std::size_t first, double fraction) {
    return is_above(quad_splits[first], fraction) && is_above(quad_splits[first + 1], fraction);
  };
  const bool along_02 = are_above(0, insignificant);
  const bool along_13 = are_above(2, insignificant);
  const bool both = along_02 == along_13;
  if (both || along_02) result.triangles.insert(result.triangles.end(), quad_splits.begin(), quad_splits.begin() + 2);
  if (both || along_13) result.triangles.insert(result.triangles.end(), quad_splits.begin() + 2, quad_splits.end());
  result.triangle_weights.assign(result.triangles.size(), both ? split_of_quad : whole_triangle);
  // Two corners may coincide, or all may be collinear.
  result.simple =
      along_02 || along_13 || are_above(0, -insignificant) || are_above(2, -insignificant) || has_no_area(corners);
}

struct FaceInfo {
  bool is_visited = false;
  int winding = 0;                         ///< winding number of the outline
  std::array<int, 3> corners{-1, -1, -1};  ///< the corner of the polygon at each vertex
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using ConstrainedDelaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// The constrained Delaunay triangulation of a polygon whose outline may touch itself at corners and run along itself
/// in the other direction, as bridges to holes do. Coincident corners are one vertex; the edges on both sides of a
/// triangle tell which of them it has.
class OutlineTriangulation {
 public:
  explicit OutlineTriangulation(const std::vector<Complex>& outline) : outline_(outline) {}

  /// Returns false if the outline crosses itself, an edge passes through another corner, parts are joined only by
  /// coincident corners, or all corners lie on one line.
  bool triangulate(std::vector<std::array<int, 3>>& triangles) {
    insert_corners();
    if (triangulation_.dimension() < 2) return false;
    list_edges();
    try {
      for (int i = 0; i < size(); ++i) {
        if (handles_[i] == handles_[next(i)]) return false;
        triangulation_.insert_constraint(handles_[i], handles_[next(i)]);
      }
    } catch (const ConstrainedDelaunay::Intersection_of_constraints_exception&) {
      return false;
    }
    return find_windings() && assign_corners() && collect(triangles);
  }

 private:
  using Face = ConstrainedDelaunay::Face_handle;  // a pointer
  /// An edge of the outline, from the vertex of one corner to that of the next.
  struct Edge {
    int from;
    int to;
    int corner;
    bool operator<(const Edge& other) const {
      return std::tie(from, to, corner) < std::tie(other.from, other.to, other.corner);
    }
  };

  int size() const { return static_cast<int>(outline_.size()); }
  int next(int corner) const { return corner + 1 == size() ? 0 : corner + 1; }

  void insert_corners() {
    std::vector<std::size_t> order(outline_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<Kernel::Point_2> points;
    points.reserve(outline_.size());
    for (const Complex p : outline_) points.emplace_back(p.real(), p.imag());
    // The order decides which of the Delaunay triangulations of cocircular corners is found. Up to this many corners
    // keep their order; for more that would take quadratic time.
    constexpr int sorted_from = 1024;
    if (size() >= sorted_from) {
      const CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::Pointer_property_map<Kernel::Point_2>::type> traits(
          CGAL::make_property_map(points));
      CGAL::spatial_sort(order.begin(), order.end(), traits);
    }
    handles_.resize(outline_.size());
    Face near;
    for (const std::size_t i : order) {
      const std::size_t before = triangulation_.number_of_vertices();
      handles_[i] = size() >= sorted_from ? triangulation_.insert(points[i], near) : triangulation_.insert(points[i]);
      near = handles_[i]->face();
      if (triangulation_.number_of_vertices() > before) handles_[i]->info() = static_cast<int>(i);
    }
  }

  void list_edges() {
    edges_.reserve(outline_.size());
    for (int i = 0; i < size(); ++i) edges_.push_back({handles_[i]->info(), handles_[next(i)]->info(), i});
    std::sort(edges_.begin(), edges_.end());
  }

  /// The corners at which edges from one vertex to another begin.
  std::pair<const Edge*, const Edge*> edges_between(int from, int to) const {
    const Edge* const begin = edges_.data();
    const Edge* const end = begin + edges_.size();
    return {std::lower_bound(begin, end, Edge{from, to, -1}), std::lower_bound(begin, end, Edge{from, to + 1, -1})};
  }
  /// The only corner at which an edge between these vertices begins, or -1.
  int corner_of_edge(int from, int to) const {
    const auto [first, last] = edges_between(from, to);
    return last - first == 1 ? first->corner : -1;
  }
  std::ptrdiff_t count(int from, int to) const {
    const auto [first, last] = edges_between(from, to);
    return last - first;
  }
  static int start_of_side(Face face, int side) { return face->vertex(face->ccw(side))->info(); }
  static int end_of_side(Face face, int side) { return face->vertex(face->cw(side))->info(); }

  /// Propagates winding numbers inward from the infinite face; false unless all are 0 or 1.
  bool find_windings() {
    std::vector<Face> stack{triangulation_.infinite_face()};
    stack.front()->info().is_visited = true;
    while (!stack.empty()) {
      const Face face = stack.back();
      stack.pop_back();
      const int winding = face->info().winding;
      if (winding != 0 && winding != 1) return false;
      for (int side = 0; side < 3; ++side) {
        const Face neighbor = face->neighbor(side);
        if (neighbor->info().is_visited) continue;
        int change = 0;
        if (face->is_constrained(side)) {
          const int from = start_of_side(face, side);
          const int to = end_of_side(face, side);
          const std::ptrdiff_t left = count(from, to);
          const std::ptrdiff_t right = count(to, from);
          if (left + right == 0) return false;  // part of an edge that passes through a corner
          change = static_cast<int>(right - left);
        }
        neighbor->info().is_visited = true;
        neighbor->info().winding = winding + change;
        stack.push_back(neighbor);
      }
    }
    return true;
  }

  /// Assigns a corner to the triangles around its vertex, from the edge that leaves the corner to the edge that
  /// arrives.
  bool assign_corners() {
    for (const Face face : triangulation_.finite_face_handles()) {
      if (face->info().winding == 0) continue;
      for (int side = 0; side < 3; ++side) {
        if (!face->is_constrained(side)) continue;
        const int corner = corner_of_edge(start_of_side(face, side), end_of_side(face, side));
        if (corner < 0 || !assign_around(face, face->ccw(side), corner)) return false;
      }
    }
    return true;
  }
  bool assign_around(Face face, int at, int corner) {
    const auto vertex = face->vertex(at);
    for (;;) {
      face->info().corners[static_cast<std::size_t>(at)] = corner;
      const int opposite = face->ccw(at);
      if (face->is_constrained(opposite)) {
        return next(corner_of_edge(start_of_side(face, opposite), end_of_side(face, opposite))) == corner;
      }
      face = face->neighbor(opposite);
      at = face->index(vertex);
    }
  }

  bool collect(std::vector<std::array<int, 3>>& triangles) const {
    for (const Face face : triangulation_.finite_face_handles()) {
      if (face->info().winding == 0) continue;
      const std::array<int, 3>& corners = face->info().corners;
      if (std::find(corners.begin(), corners.end(), -1) != corners.end()) return false;
      triangles.push_back(corners);
    }
    return static_cast<int>(triangles.size()) == size() - 2;
  }

  const std::vector<Complex>& outline_;
  ConstrainedDelaunay triangulation_;
  std::vector<ConstrainedDelaunay::Vertex_handle> handles_;
  std::vector<Edge> edges_;  ///< sorted
};

/// The polygon projected along Newell's normal, counterclockwise; empty if the normal vanishes.
std::vector<Complex> projected(const Eigen::Ref<const Positions>& corners) {
  const Vector center = corners.colwise().mean().transpose();
  const Vector normal = polygon_normal(corners, center);
  if (!(normal.squaredNorm() > 0) || !normal.allFinite()) return {};
  const auto [first, second] = plane_axes(normal);
  std::vector<Complex> outline;
  outline.reserve(static_cast<std::size_t>(corners.rows()));
  for (Eigen::Index i = 0; i < corners.rows(); ++i) {
    const Vector p = corners.row(i).transpose() - center;
    outline.emplace_back(p.dot(first), p.dot(second));
  }
  return outline;
}

/// Whether the outline clearly winds around some place otherwise than once or not at all, as found in a sample of
/// places: no triangles then cover it once (covers_once), and ears need not be clipped to find out, which takes
/// quadratic time on outlines that cross themselves everywhere.
bool winds_badly(const std::vector<Complex>& outline, double clearance) {
  constexpr std::uint64_t sample = 64;
  const PlaneBox box = PlaneBox::of(outline);
  for (std::uint64_t k = 0; k < sample; ++k) {
    const auto between = [&](int axis, std::uint64_t seed) {
      return box.low[axis] + 0.5 * (1 + pseudo_random(k + 1, seed)) * (box.high[axis] - box.low[axis]);
    };
    const Complex place(between(0, 0), between(1, 1));
    int winding = 0;
    bool is_clear = true;
    for (std::size_t i = 0; i < outline.size() && is_clear; ++i) {
      const Complex a = outline[i] - place;
      const Complex b = outline[i + 1 < outline.size() ? i + 1 : 0] - place;
      const double height = cross(a, b);  // times the length of the edge
      // The edges that cross the ray to the right, those that touch it from above left out.
      if (a.imag() <= 0 && b.imag() > 0 && height > 0) ++winding;
      if (a.imag() > 0 && b.imag() <= 0 && height < 0) --winding;
      const Complex side = b - a;
      const double square = std::norm(side);
      const double at = square > 0 ? std::clamp(-dot(side, a) / square, 0.0, 1.0) : 0.0;
      is_clear = std::norm(a + at * side) > clearance * clearance;
    }
    poll(outline.size());
    if (is_clear && winding != 0 && winding != 1) return true;
  }
  return false;
}

/// Returns false when the projected polygon is not weakly simple.
bool triangulate_outline(const Eigen::Ref<const Positions>& corners, std::vector<std::array<int, 3>>& triangles) {
  const std::vector<Complex> outline = projected(corners);
  if (outline.empty()) return false;
  if (OutlineTriangulation(outline).triangulate(triangles)) return true;
  // Corners lie on an edge up to rounding, in single precision if they come from a file.
  double extent = 0;
  for (const Complex p : outline) extent = std::max(extent, std::abs(p));
  // Much more than what covers_once allows.
  if (winds_badly(outline, 100 * single_rounding * extent)) return false;
  for (const double tolerance : {0.0, single_rounding * extent}) {
    triangles = clip_ears(outline, tolerance);
    if (covers_once(outline, triangles, single_rounding * extent)) return true;
  }
  triangles.clear();
  return false;
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
    result.triangle_weights.push_back(whole_triangle);
    return;
  }
  if (corners.rows() == 4) {
    triangulate_quad(corners, result);
    return;
  }
  if (!corners.allFinite() || !triangulate_outline(corners, result.triangles)) {
    fan(corners, result);
    result.simple = has_no_area(corners);
  }
  result.triangle_weights.assign(result.triangles.size(), whole_triangle);
}

}  // namespace spectral_conformal
