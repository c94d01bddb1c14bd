#include "spectral_conformal/overlap.h"

#include <CGAL/Box_intersection_d/Box_with_handle_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>

#include "spectral_conformal/injectivity.h"
#include "spectral_conformal/map_triangulation.h"

namespace spectral_conformal {
namespace {

/// A triangle in the plane, with what every pair of triangles needs.
struct PlaneTriangle {
  std::array<Complex, 3> corners;
  std::array<Complex, 3> inwards;  ///< unit normal of each side; 0 for a side without length
  std::array<double, 3> height;    ///< over each side, negative for a clockwise triangle
  double size;                     ///< longest side
  double reach;                    ///< largest coordinate

  explicit PlaneTriangle(const std::array<Complex, 3>& c) : corners(c), size(0), reach(0) {
    for (int k = 0; k < 3; ++k) {
      const Complex side = c[(k + 1) % 3] - c[k];
      const double length = std::abs(side);
      inwards[k] = length > 0 ? Complex(0, 1) * (side / length) : Complex(0);
      height[k] = over_side(k, c[(k + 2) % 3]);
      size = std::max(size, length);
      reach = std::max({reach, std::abs(c[k].real()), std::abs(c[k].imag())});
    }
  }
  double over_side(int k, Complex p) const {
    const Complex d = p - corners[k];
    return inwards[k].real() * d.real() + inwards[k].imag() * d.imag();
  }
};

/// Whether the two have at most `tolerance` in common across one of the sides of `a`. A collapsed triangle has nothing
/// in common with any.
bool separated_by_side(const PlaneTriangle& a, const PlaneTriangle& b, double tolerance) {
  for (int k = 0; k < 3; ++k) {
    if (a.inwards[k] == 0.0) continue;
    const double first = a.over_side(k, b.corners[0]);
    const double second = a.over_side(k, b.corners[1]);
    const double third = a.over_side(k, b.corners[2]);
    const double top = std::min(std::max({first, second, third}), std::max(a.height[k], 0.0));
    const double bottom = std::max(std::min({first, second, third}), std::min(a.height[k], 0.0));
    if (top - bottom <= tolerance) return true;
  }
  return false;
}

/// The handle tells which triangle it is.
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, const std::array<int, 3>*>;
constexpr std::ptrdiff_t cutoff = 10;  // CGAL's default, below which it looks at all pairs

/// The triangles of a map, and which of them were found to overlap.
class OverlapTest {
 public:
  OverlapTest(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map, const std::vector<int>& face,
              double resolution)
      : triangles_(triangles), face_(face), resolution_(resolution), overlapping_(triangles.size(), false) {
    // Products of coordinates must neither overflow nor vanish, whatever the unit.
    const double extent = map.size() == 0 ? 0 : map.cwiseAbs().maxCoeff();
    if (!(extent > 0)) return;
    z_ = map / extent;
    boxes_.reserve(triangles.size());
    for (const auto& triangle : triangles) boxes_.push_back(box_of(triangle));
  }

  /// Looks at all pairs.
  std::vector<bool> among_all() {
    std::vector<PlaneTriangle> in_plane;
    in_plane.reserve(boxes_.size());
    for (std::size_t t = 0; t < boxes_.size(); ++t) in_plane.push_back(placed(t));
    CGAL::box_self_intersection_d(
        boxes_.begin(), boxes_.end(),
        [&](const Box& first, const Box& second) {
          const std::size_t a = index(first);
          const std::size_t b = index(second);
          if (is_open(a, b)) compare(a, in_plane[a], b, in_plane[b]);
        },
        cutoff, CGAL::Box_intersection_d::HALF_OPEN);
    return overlapping_;
  }

  /// Looks at pairs with one of these only, which should be few.
  std::vector<bool> with(const std::vector<int>& some) {
    if (boxes_.empty()) return overlapping_;
    std::vector<Box> some_boxes;
    some_boxes.reserve(some.size());
    for (const int triangle : some) some_boxes.push_back(boxes_[static_cast<std::size_t>(triangle)]);
    CGAL::box_intersection_d(
        some_boxes.begin(), some_boxes.end(), boxes_.begin(), boxes_.end(),
        [&](const Box& first, const Box& second) {
          const std::size_t a = index(first);
          const std::size_t b = index(second);
          if (a != b && is_open(a, b)) compare(a, placed(a), b, placed(b));
        },
        cutoff, CGAL::Box_intersection_d::HALF_OPEN);
    return overlapping_;
  }

 private:
  Box box_of(const std::array<int, 3>& triangle) const {
    const Complex a = z_[triangle[0]];
    const Complex b = z_[triangle[1]];
    const Complex c = z_[triangle[2]];
    double low[2] = {std::min({a.real(), b.real(), c.real()}), std::min({a.imag(), b.imag(), c.imag()})};
    double high[2] = {std::max({a.real(), b.real(), c.real()}), std::max({a.imag(), b.imag(), c.imag()})};
    return {low, high, &triangle};
  }

  std::size_t index(const Box& box) const { return static_cast<std::size_t>(box.handle() - triangles_.data()); }

  PlaneTriangle placed(std::size_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return PlaneTriangle({z_[a], z_[b], z_[c]});
  }

  /// Whether the pair could tell something new.
  bool is_open(std::size_t a, std::size_t b) const {
    return !(overlapping_[a] && overlapping_[b]) && (face_.empty() || face_[a] != face_[b]);
  }

  void compare(std::size_t one, const PlaneTriangle& a, std::size_t other, const PlaneTriangle& b) {
    const double tolerance = std::max(1e-9 * std::min(a.size, b.size), resolution_ * std::max(a.reach, b.reach));
    if (separated_by_side(a, b, tolerance) || separated_by_side(b, a, tolerance)) return;
    overlapping_[one] = true;
    overlapping_[other] = true;
  }

  const std::vector<std::array<int, 3>>& triangles_;
  const std::vector<int>& face_;
  double resolution_;
  ComplexVector z_;
  std::vector<Box> boxes_;
  std::vector<bool> overlapping_;
};

}  // namespace

std::vector<bool> overlapping_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map,
                                        const std::vector<int>& face, double resolution) {
  return OverlapTest(triangles, map, face, resolution).among_all();
}

std::vector<int> overlapping_faces(const Chart& chart, const ComplexVector& z, double resolution) {
  const MapTriangulation map = triangulate_map(chart, z);
  std::vector<bool> overlapping;
  // Without a consistent orientation the edges within the patch do not cancel.
  if (chart.orientable && has_degree_at_most_one(chart.boundary_loops, z)) {
    const std::vector<int> doubtful = doubtful_triangles(map.triangles, z);
    if (doubtful.empty()) return {};
    overlapping = OverlapTest(map.triangles, z, map.face, resolution).with(doubtful);
  } else {
    overlapping = OverlapTest(map.triangles, z, map.face, resolution).among_all();
  }
  std::vector<int> result;
  for (std::size_t t = 0; t < map.face.size(); ++t) {
    if (overlapping[t] && (result.empty() || result.back() != map.face[t])) result.push_back(map.face[t]);
  }
  return result;
}

}  // namespace spectral_conformal
