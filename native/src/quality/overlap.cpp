#include "quality/overlap.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/quad_splits.h"
#include "quality/box_tree.h"
#include "quality/flips.h"
#include "quality/map_degree.h"

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

/// The triangles of a map, and which of them were found to overlap others.
class OverlapTest {
 public:
  OverlapTest(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map, const std::vector<int>& face,
              double resolution)
      : triangles_(triangles), face_(face), resolution_(resolution), overlapping_(triangles.size(), false) {
    // Products of coordinates must neither overflow nor vanish, whatever the unit.
    double extent = 0;
    for (const auto& triangle : triangles) {
      for (const int v : triangle) extent = std::max({extent, std::abs(map[v].real()), std::abs(map[v].imag())});
    }
    if (extent > 0) z_ = map / extent;
  }

  const std::vector<bool>& among_all() {
    std::vector<int> all(triangles_.size());
    std::iota(all.begin(), all.end(), 0);
    find_overlaps(all, true);
    return overlapping_;
  }

  /// Tests pairs with one of these only.
  const std::vector<bool>& with(std::vector<int> some) {
    find_overlaps(some, true);
    // Of these, what overlaps none of them may overlap others, which had found another of them first.
    some.erase(std::remove_if(some.begin(), some.end(), [&](int t) { return overlapping_[t]; }), some.end());
    find_overlaps(some, false);
    return overlapping_;
  }

 private:
  /// Asks every triangle which of `some` it overlaps; with `one_is_enough` only until there is one, so that faces which
  /// are stacked a thousandfold do not cost a million pairs.
  void find_overlaps(const std::vector<int>& some, bool one_is_enough) {
    if (z_.size() == 0) return;
    std::vector<PlaneTriangle> placed;
    std::vector<PlaneBox> boxes;
    placed.reserve(some.size());
    boxes.reserve(some.size());
    for (const int triangle : some) {
      placed.push_back(place(static_cast<std::size_t>(triangle)));
      boxes.push_back(box_of(static_cast<std::size_t>(triangle)));
    }
    const BoxTree tree(boxes);
    const bool all = some.size() == triangles_.size();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (one_is_enough && overlapping_[t]) continue;
      std::optional<PlaneTriangle> own;
      tree.for_each_meeting(box_of(t), [&](int k) {
        const auto other = static_cast<std::size_t>(some[static_cast<std::size_t>(k)]);
        if (other == t || (!face_.empty() && face_[other] == face_[t])) return true;
        if (overlapping_[t] && overlapping_[other]) return true;
        // It has met all triangles, this one among them, and overlapped none.
        if (all && other < t && !overlapping_[other]) return true;
        if (!own) own = place(t);
        if (!overlap(*own, placed[static_cast<std::size_t>(k)])) return true;
        overlapping_[t] = true;
        overlapping_[other] = true;
        return !one_is_enough;
      });
    }
  }

  PlaneTriangle place(std::size_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return PlaneTriangle({z_[a], z_[b], z_[c]});
  }

  PlaneBox box_of(std::size_t t) const {
    const Complex a = z_[triangles_[t][0]];
    const Complex b = z_[triangles_[t][1]];
    const Complex c = z_[triangles_[t][2]];
    return {{std::min({a.real(), b.real(), c.real()}), std::min({a.imag(), b.imag(), c.imag()})},
            {std::max({a.real(), b.real(), c.real()}), std::max({a.imag(), b.imag(), c.imag()})}};
  }

  bool overlap(const PlaneTriangle& a, const PlaneTriangle& b) const {
    // Neighbours share an edge up to rounding of their heights, some 1e-16 of the coordinates; 1e-9 leaves room for
    // triangles a millionth of the map's extent.
    constexpr double contact = 1e-9;
    const double tolerance = std::max(contact * std::min(a.size, b.size), resolution_ * std::max(a.reach, b.reach));
    return !separated_by_side(a, b, tolerance) && !separated_by_side(b, a, tolerance);
  }

  const std::vector<std::array<int, 3>>& triangles_;
  const std::vector<int>& face_;
  double resolution_;
  ComplexVector z_;  ///< empty where the map has no extent
  std::vector<bool> overlapping_;
};

}  // namespace

std::vector<bool> overlapping_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map,
                                        const std::vector<int>& face, double resolution) {
  return OverlapTest(triangles, map, face, resolution).among_all();
}

std::vector<int> overlapping_faces(const Chart& chart, const ComplexVector& z, double resolution) {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face;
  for (const int t : mapped_triangulation(chart.triangles, chart.triangle_weights, z)) {
    triangles.push_back(chart.triangles[static_cast<std::size_t>(t)]);
    face.push_back(chart.triangle_face[static_cast<std::size_t>(t)]);
  }
  std::vector<bool> overlapping;
  // Without a consistent orientation the edges within the chart do not cancel.
  if (chart.orientable && has_degree_at_most_one(chart.boundary_loops, z)) {
    std::vector<int> non_positive = non_positive_triangles(triangles, z);
    if (non_positive.empty()) return {};
    overlapping = OverlapTest(triangles, z, face, resolution).with(std::move(non_positive));
  } else {
    overlapping = OverlapTest(triangles, z, face, resolution).among_all();
  }
  std::vector<int> result;
  for (std::size_t t = 0; t < face.size(); ++t) {
    if (overlapping[t] && (result.empty() || result.back() != face[t])) result.push_back(face[t]);
  }
  return result;
}

}  // namespace spectral_conformal
