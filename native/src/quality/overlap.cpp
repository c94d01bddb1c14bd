#include "quality/overlap.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/box_tree.h"
#include "geometry/quad_splits.h"
#include "graph/parallel_calls.h"
#include "quality/flips.h"
#include "quality/map_degree.h"

namespace spectral_conformal {
namespace {

/// Triangles that a thread tests at a time.
constexpr std::size_t tested_at_once = 4096;
constexpr double testing_nanoseconds = 1000;

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

/// Whether `t` tests the pair that it makes with `other`, which does so otherwise. Of many triangles at one place each
/// has about as many to test, in whatever order they come: one soon finds another that it overlaps.
bool tests_pair(std::size_t t, std::size_t other) { return (t + other) % 2 == 0 ? t < other : t > other; }

/// The triangles of a map, and which of them were found to overlap others. Threads share the triangles; which pairs are
/// tested depends on them where triangles overlap several others, what is found does not.
class OverlapTest {
 public:
  OverlapTest(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map, const std::vector<int>& face,
              double resolution)
      : triangles_(triangles), face_(face), resolution_(resolution), overlapping_(triangles.size()) {
    // Products of coordinates must neither overflow nor vanish, whatever the unit.
    double extent = 0;
    for (const auto& triangle : triangles) {
      for (const int v : triangle) extent = std::max({extent, std::abs(map[v].real()), std::abs(map[v].imag())});
    }
    if (extent > 0) z_ = map / extent;
  }

  /// A triangle that overlaps another tests no more pairs, so that faces which are stacked a thousandfold do not cost a
  /// million.
  std::vector<bool> among_all() {
    if (z_.size() == 0) return result();
    std::vector<int> numbers(triangles_.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    const Subset all = subset(one_of_each_stack(numbers));
    for_each_triangle([&](std::size_t t) {
      if (!overlaps(t)) find_overlaps(t, all, tests_pair, true);
    });
    // What overlaps none of those whose pairs it tested may overlap one that tested no more.
    std::vector<int> found = all.triangles;
    found.erase(std::remove_if(found.begin(), found.end(), [&](int t) { return !overlaps(t); }), found.end());
    test_with(subset(std::move(found)), true);
    return result();
  }

  /// Tests pairs with one of these only.
  std::vector<bool> with(std::vector<int> some) {
    if (z_.size() == 0) return result();
    some = one_of_each_stack(some);
    test_with(subset(some), true);
    // Of these, what overlaps none of them may overlap others, which had found another of them first.
    some.erase(std::remove_if(some.begin(), some.end(), [&](int t) { return overlaps(t); }), some.end());
    test_with(subset(std::move(some)), false);
    return result();
  }

 private:
  struct Subset {
    std::vector<int> triangles;
    std::vector<PlaneTriangle> placed;
    BoxTree tree;
  };

  Subset subset(std::vector<int> triangles) const {
    std::vector<PlaneTriangle> placed;
    std::vector<PlaneBox> boxes;
    placed.reserve(triangles.size());
    boxes.reserve(triangles.size());
    for (const int t : triangles) {
      placed.push_back(place(t));
      boxes.push_back(box_of(t));
    }
    return {std::move(triangles), std::move(placed), BoxTree(boxes)};
  }

  /// Leaves out those that lie exactly on another one, of which many may, in its order of corners: what is found of one
  /// holds for all. Two stay where the faces differ, since pairs of one face do not count.
  std::vector<int> one_of_each_stack(const std::vector<int>& some) {
    const auto place_of = [this](int t) {
      const auto& [a, b, c] = triangles_[static_cast<std::size_t>(t)];
      return std::array<double, 6>{z_[a].real(), z_[a].imag(), z_[b].real(), z_[b].imag(), z_[c].real(), z_[c].imag()};
    };
    std::vector<std::pair<std::array<double, 6>, int>> placed;
    placed.reserve(some.size());
    for (const int t : some) placed.emplace_back(place_of(t), t);
    std::sort(placed.begin(), placed.end());
    const auto face_of = [this](int t) { return face_.empty() ? t : face_[static_cast<std::size_t>(t)]; };
    std::vector<int> result;
    result.reserve(some.size());
    for (std::size_t i = 0; i < placed.size();) {
      const int first = placed[i].second;
      result.push_back(first);
      bool has_other_face = false;
      std::size_t k = i + 1;
      for (; k < placed.size() && placed[k].first == placed[i].first; ++k) {
        const int t = placed[k].second;
        if (!has_other_face && face_of(t) != face_of(first)) {
          has_other_face = true;
          result.push_back(t);
        } else {
          stacked_.emplace_back(first, t);
        }
      }
      i = k;
    }
    if (!stacked_.empty()) {
      is_left_out_.assign(triangles_.size(), 0);
      for (const auto& [first, t] : stacked_) is_left_out_[static_cast<std::size_t>(t)] = 1;
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  bool overlaps(std::size_t t) const { return overlapping_[t].load(std::memory_order_relaxed); }
  void mark(std::size_t t) { overlapping_[t].store(true, std::memory_order_relaxed); }
  std::vector<bool> result() {
    for (const auto& [first, t] : stacked_) {
      if (overlaps(static_cast<std::size_t>(first))) mark(static_cast<std::size_t>(t));
    }
    return {overlapping_.begin(), overlapping_.end()};
  }

  template <class Work>
  void for_each_triangle(const Work& work) const {
    run_blocks_in_parallel(triangles_.size(), tested_at_once, testing_nanoseconds,
                           [&](std::size_t begin, std::size_t end) {
                             for (std::size_t t = begin; t < end; ++t) {
                               if (is_left_out_.empty() || is_left_out_[t] == 0) work(t);
                             }
                           });
  }

  /// Asks every triangle, or with `one_is_enough` those not found yet, which of `some` it overlaps.
  void test_with(const Subset& some, bool one_is_enough) {
    if (some.triangles.empty()) return;
    const auto any = [](std::size_t, std::size_t) { return true; };
    for_each_triangle([&](std::size_t t) {
      if (!one_is_enough || !overlaps(t)) find_overlaps(t, some, any, one_is_enough);
    });
  }

  /// Marks a triangle and those of `some` that it overlaps, all or one.
  template <class Tested>
  void find_overlaps(std::size_t t, const Subset& some, const Tested& is_tested, bool one_is_enough) {
    std::optional<PlaneTriangle> own;
    some.tree.for_each_meeting(box_of(t), [&](int k) {
      const auto other = static_cast<std::size_t>(some.triangles[static_cast<std::size_t>(k)]);
      if (other == t || (!face_.empty() && face_[other] == face_[t])) return true;
      if (!is_tested(t, other) || (overlaps(t) && overlaps(other))) return true;
      if (!own) own = place(t);
      if (!overlap(*own, some.placed[static_cast<std::size_t>(k)])) return true;
      mark(t);
      mark(other);
      return !one_is_enough;
    });
  }

  PlaneTriangle place(std::size_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return PlaneTriangle({z_[a], z_[b], z_[c]});
  }

  PlaneBox box_of(std::size_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return PlaneBox::of({z_[a], z_[b], z_[c]});
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
  ComplexVector z_;                           ///< empty where the map has no extent
  std::vector<std::pair<int, int>> stacked_;  ///< a triangle, and one left out that lies on it
  std::vector<char> is_left_out_;             ///< per triangle; empty where none is
  std::vector<std::atomic<bool>> overlapping_;
};

}  // namespace

std::vector<bool> overlapping_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map,
                                        const std::vector<int>& face, double resolution) {
  return OverlapTest(triangles, map, face, resolution).among_all();
}

void MapOfCharts::add(const Chart& chart, const ComplexVector& chart_z, bool is_mirrored, const std::vector<int>& which,
                      const std::vector<int>& face_of_each) {
  const int first = static_cast<int>(z.size());
  for (const int t : which) {
    const auto& [a, b, c] = chart.triangles[static_cast<std::size_t>(t)];
    if (!chart.orientable) loose.push_back(static_cast<int>(triangles.size()));
    triangles.push_back({first + a, first + b, first + c});
    mirrored.push_back(is_mirrored ? 1 : 0);
  }
  face.insert(face.end(), face_of_each.begin(), face_of_each.end());
  z.insert(z.end(), chart_z.begin(), chart_z.end());
  if (!chart.orientable) return;
  for (BoundaryLoop loop : chart.boundary_loops) {
    for (int& v : loop) v += first;
    if (is_mirrored) std::reverse(loop.begin(), loop.end());
    loops.push_back(std::move(loop));
  }
}

void MapOfCharts::add_loose(const std::array<Complex, 3>& corners, int its_face) {
  const int first = static_cast<int>(z.size());
  loose.push_back(static_cast<int>(triangles.size()));
  triangles.push_back({first, first + 1, first + 2});
  mirrored.push_back(0);
  face.push_back(its_face);
  z.insert(z.end(), corners.begin(), corners.end());
}

std::vector<bool> overlapping_in_map(const MapOfCharts& map, double resolution) {
  const ComplexVector z = Eigen::Map<const ComplexVector>(map.z.data(), static_cast<Eigen::Index>(map.z.size()));
  OverlapTest test(map.triangles, z, map.face, resolution);
  if (!have_degree_at_most_one(map.loops, z)) return test.among_all();
  std::vector<std::array<int, 3>> upright = map.triangles;
  for (std::size_t t = 0; t < upright.size(); ++t) {
    if (map.mirrored[t] != 0) std::swap(upright[t][1], upright[t][2]);
  }
  std::vector<int> suspects = non_positive_triangles(upright, z);
  suspects.insert(suspects.end(), map.loose.begin(), map.loose.end());
  std::sort(suspects.begin(), suspects.end());
  suspects.erase(std::unique(suspects.begin(), suspects.end()), suspects.end());
  return test.with(std::move(suspects));
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
  if (chart.orientable) {
    std::vector<int> suspects = overlap_suspects(triangles, chart.boundary_loops, z);
    if (suspects.empty()) return {};
    overlapping = OverlapTest(triangles, z, face, resolution).with(std::move(suspects));
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
