#include "quality/overlap.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/box_tree.h"
#include "geometry/orientation.h"
#include "geometry/plane_triangle.h"
#include "geometry/point_merging.h"
#include "geometry/quad_splits.h"
#include "geometry/triangle_sweep.h"
#include "quality/flips.h"
#include "quality/map_degree.h"

namespace spectral_conformal {
namespace {

/// Whether `t` tests its pair with `other`; if not, `other` does. Each of many stacked triangles has about equally many
/// pairs to test, in any order, so it soon finds an overlap.
bool tests_pair(std::size_t t, std::size_t other) { return (t + other) % 2 == 0 ? t < other : t > other; }
bool any_pair(std::size_t, std::size_t) { return true; }

/// The triangles of a map, and which of them were found to overlap others. Threads share the triangles. If triangles
/// overlap several others, the pairs tested depend on the threads; the result does not.
class OverlapTest {
 public:
  OverlapTest(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& map, const std::vector<int>& face,
              double resolution)
      : triangles_(triangles), face_(face), resolution_(resolution), overlapping_(triangles.size()) {
    // Products of coordinates must neither overflow nor underflow, whatever the unit. A power of two preserves
    // collinearity.
    double extent = 0;
    for_each_polled(triangles.size(), [&](std::size_t t) {
      for (const int v : triangles[t]) extent = std::max({extent, std::abs(map[v].real()), std::abs(map[v].imag())});
    });
    if (!(extent > 0)) return;
    const int exponent = std::ilogb(extent);
    z_ = map * std::ldexp(1.0, -exponent / 2) * std::ldexp(1.0, exponent / 2 - exponent);
  }

  /// A triangle known to overlap tests no more pairs: a stack of a thousand faces must not cost a million tests.
  std::vector<bool> among_all() {
    if (z_.size() == 0 || are_all_of_one_face()) return result();
    const Subset all = subset(one_of_each_stack(those_left()));
    bool is_done = for_each_triangle(
        [&](std::size_t t) { return overlaps(t) ? std::size_t{0} : find_overlaps(t, all, tests_pair, true); });
    // A triangle without an overlap so far may overlap one that stopped testing.
    if (is_done) is_done = test_with(subset(without_others(all.triangles, true)), true);
    if (!is_done) sweep(all.triangles);
    return result();
  }

  /// Tests only pairs with one of these triangles, unless there are too many.
  std::vector<bool> with(const std::vector<int>& some) {
    if (z_.size() == 0 || are_all_of_one_face()) return result();
    if (!test_those_with(one_of_each_stack(some))) sweep(subset(one_of_each_stack(those_left())).triangles);
    return result();
  }

 private:
  struct Subset {
    std::vector<int> triangles;
    std::vector<PlaneTriangle> placed;
    BoxTree tree;
  };

  /// Omits triangles that cover nothing.
  Subset subset(const std::vector<int>& triangles) {
    std::vector<int> covering;
    std::vector<PlaneTriangle> placed;
    std::vector<PlaneBox> boxes;
    covering.reserve(triangles.size());
    placed.reserve(triangles.size());
    boxes.reserve(triangles.size());
    for_each_polled(triangles.size(), [&](std::size_t i) {
      const int t = triangles[i];
      const PlaneTriangle triangle = place(t);
      if (covers_nothing(triangle)) {
        leave_out(t);
        return;
      }
      covering.push_back(t);
      placed.push_back(triangle);
      boxes.push_back(box_of(t));
    });
    return {std::move(covering), std::move(placed), BoxTree::over(boxes)};
  }

  void leave_out(int t) {
    if (is_left_out_.empty()) is_left_out_.assign(triangles_.size(), 0);
    is_left_out_[static_cast<std::size_t>(t)] = 1;
  }
  std::vector<int> those_left() const {
    std::vector<int> numbers(triangles_.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    if (is_left_out_.empty()) return numbers;
    const auto is_out = [this](int t) { return is_left_out_[static_cast<std::size_t>(t)] != 0; };
    numbers.erase(std::remove_if(numbers.begin(), numbers.end(), is_out), numbers.end());
    return numbers;
  }
  /// Those of the given triangles that were found to overlap, or those that were not.
  std::vector<int> without_others(std::vector<int> some, bool overlapping) const {
    const auto is_other = [&](int t) { return overlaps(static_cast<std::size_t>(t)) != overlapping; };
    some.erase(std::remove_if(some.begin(), some.end(), is_other), some.end());
    return some;
  }

  /// Keeps one triangle of each stack of coincident triangles with the same order of corners: its result holds for all.
  /// Keeps two if the faces differ, since pairs of one face do not count.
  std::vector<int> one_of_each_stack(const std::vector<int>& some) {
    const auto place_of = [this](int t) {
      const auto& [a, b, c] = triangles_[static_cast<std::size_t>(t)];
      return std::array<double, 6>{z_[a].real(), z_[a].imag(), z_[b].real(), z_[b].imag(), z_[c].real(), z_[c].imag()};
    };
    std::vector<std::pair<std::array<double, 6>, int>> placed;
    placed.reserve(some.size());
    for_each_polled(some.size(), [&](std::size_t i) { placed.emplace_back(place_of(some[i]), some[i]); });
    call_while_polling(placed.size(), [&] { std::sort(placed.begin(), placed.end()); });
    const auto face_of = [this](int t) { return face_.empty() ? t : face_[static_cast<std::size_t>(t)]; };
    std::vector<int> result;
    result.reserve(some.size());
    for (std::size_t i = 0; i < placed.size();) {
      poll();
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
          leave_out(t);
        }
      }
      i = k;
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  bool overlaps(std::size_t t) const { return overlapping_[t].load(std::memory_order_relaxed); }
  void mark(std::size_t t) { overlapping_[t].store(true, std::memory_order_relaxed); }
  std::vector<bool> result() {
    // A triangle removed late may represent others: go backward.
    for (auto pair = stacked_.rbegin(); pair != stacked_.rend(); ++pair) {
      if (overlaps(static_cast<std::size_t>(pair->first))) mark(static_cast<std::size_t>(pair->second));
    }
    return {overlapping_.begin(), overlapping_.end()};
  }

  /// Calls work(t), which returns the number of pairs visited, for every triangle, until there are too many. Returns
  /// whether it reached all.
  template <class Work>
  bool for_each_triangle(const Work& work, std::size_t max_pairs = pairs_of_each) const {
    const std::size_t limit = max_pairs == no_limit ? no_limit : max_pairs * triangles_.size();
    std::atomic<std::size_t> pairs{0};
    run_blocks_in_parallel(triangles_.size(), std::size_t{1000}, [&](std::size_t begin, std::size_t end) {
      const std::size_t before = pairs.load(std::memory_order_relaxed);
      std::size_t own = 0;
      for (std::size_t t = begin; t < end && before + own <= limit; ++t) {
        if (is_left_out_.empty() || is_left_out_[t] == 0) own += work(t);
      }
      pairs.fetch_add(own, std::memory_order_relaxed);
    });
    return pairs.load(std::memory_order_relaxed) <= limit;
  }

  /// Tests every triangle, or with `one_is_enough` those not found yet, against `some`.
  bool test_with(const Subset& some, bool one_is_enough, std::size_t max_pairs = pairs_of_each) {
    if (some.triangles.empty()) return true;
    return for_each_triangle(
        [&](std::size_t t) {
          return one_is_enough && overlaps(t) ? std::size_t{0} : find_overlaps(t, some, any_pair, one_is_enough);
        },
        max_pairs);
  }

  /// Tests all pairs with one of these triangles.
  bool test_those_with(const std::vector<int>& some, std::size_t max_pairs = pairs_of_each) {
    // One of these without an overlap among them may overlap others, which had found another of these first.
    return test_with(subset(some), true, max_pairs) && test_with(subset(without_others(some, false)), false, max_pairs);
  }

  /// Marks a triangle and those of `some` that it overlaps, all or one. Returns the number of boxes met.
  template <class Tested>
  std::size_t find_overlaps(std::size_t t, const Subset& some, const Tested& is_tested, bool one_is_enough) {
    std::optional<PlaneTriangle> own;
    std::size_t met = 0;
    some.tree.for_each_meeting(box_of(t), [&](int k) {
      ++met;
      const auto other = static_cast<std::size_t>(some.triangles[static_cast<std::size_t>(k)]);
      if (other == t || are_of_one_face(t, other)) return true;
      if (!is_tested(t, other) || (overlaps(t) && overlaps(other))) return true;
      if (!own) {
        own = place(t);
        if (covers_nothing(*own)) return false;
      }
      if (!overlap_in_map(*own, some.placed[static_cast<std::size_t>(k)], resolution_)) return true;
      mark(t);
      mark(other);
      return !one_is_enough;
    });
    return met;
  }

  /// Finds the overlaps of the given triangles (all but those omitted) if too many boxes meet. Each round sweeps a line
  /// over the triangles without overlap and over as many others as do not meet them; of two that meet, one waits for
  /// the next round. Then it tests pairs of the waiting triangles, at about the same cost.
  void sweep(std::vector<int> others) {
    const ComplexVector merged = merged_within_tolerance();
    std::vector<int> apart;   // not found to overlap, pairwise disjoint
    std::vector<int> barely;  // met another not deeply enough to count, or of its own face: test pair by pair
    while (!others.empty()) {
      others = sweep_once(merged, apart, others, barely);
      if (apart.empty()) break;
      // All others are known to overlap, and the triangles no longer among them meet none of these.
      std::vector<char> waits(triangles_.size(), 0);
      for (const int t : apart) waits[static_cast<std::size_t>(t)] = 1;
      const Subset left = subset(others);
      for_each_triangle([&](std::size_t t) {
        if (waits[t] == 0) return std::size_t{0};
        waits[t] = 0;
        return find_overlaps(t, left, any_pair, true);
      });
      apart.erase(
          std::remove_if(apart.begin(), apart.end(), [&](int t) { return waits[static_cast<std::size_t>(t)] == 0; }),
          apart.end());
    }
    test_those_with(barely, no_limit);
  }

  /// Sweeps a line over the triangles `apart` and `others`. Returns those of `others` that meet another. Sets `apart`
  /// to the triangles of both that meet none and were not found to overlap.
  std::vector<int> sweep_once(const ComplexVector& merged, std::vector<int>& apart, const std::vector<int>& others,
                              std::vector<int>& barely) {
    const auto n_apart = static_cast<int>(apart.size());
    std::vector<int> swept = apart;
    swept.insert(swept.end(), others.begin(), others.end());
    std::vector<std::array<Complex, 3>> corners;
    corners.reserve(swept.size());
    for (const int t : swept) corners.push_back(counterclockwise(static_cast<std::size_t>(t), merged));
    std::vector<int> next;
    std::vector<char> is_out(swept.size(), 0);
    sweep_triangles(corners, [&](int i, int k) {
      const auto first = static_cast<std::size_t>(swept[static_cast<std::size_t>(i)]);
      const auto second = static_cast<std::size_t>(swept[static_cast<std::size_t>(k)]);
      const bool is_deep =
          (overlaps(first) && overlaps(second)) ||
          (!are_of_one_face(first, second) && overlap_in_map(place(first), place(second), resolution_));
      if (is_deep) {
        mark(first);
        mark(second);
      }
      const bool is_known_apart = std::min(i, k) < n_apart;
      // A triangle that extends farther finds more.
      const bool first_ends =
          right_end(corners[static_cast<std::size_t>(i)]) < right_end(corners[static_cast<std::size_t>(k)]);
      const int out = is_known_apart ? (is_deep ? std::min(i, k) : std::max(i, k)) : (first_ends ? i : k);
      is_out[static_cast<std::size_t>(out)] = 1;
      if (out >= n_apart) (is_deep ? next : barely).push_back(swept[static_cast<std::size_t>(out)]);
      return out;
    });
    apart.clear();
    for (std::size_t i = 0; i < swept.size(); ++i) {
      if (is_out[i] == 0 && !overlaps(static_cast<std::size_t>(swept[i]))) apart.push_back(swept[i]);
    }
    return next;
  }

  /// Then no pair counts.
  bool are_all_of_one_face() const {
    return std::adjacent_find(face_.begin(), face_.end(), std::not_equal_to<>()) == face_.end() && !face_.empty();
  }
  bool are_of_one_face(std::size_t t, std::size_t other) const { return !face_.empty() && face_[other] == face_[t]; }

  PlaneTriangle place(std::size_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return PlaneTriangle({z_[a], z_[b], z_[c]});
  }

  /// Merges points less than half a tolerance apart, so that islands touching up to rounding touch exactly. Overlaps
  /// deep enough to count survive, and no triangle with area turns over.
  ComplexVector merged_within_tolerance() const {
    if (resolution_ == 0) return z_;
    std::vector<double> tolerances;
    for (const Complex p : z_) {
      tolerances.push_back(resolution_ * std::max(std::abs(p.real()), std::abs(p.imag())));
    }
    return merge_points(z_, tolerances);
  }
  std::array<Complex, 3> counterclockwise(std::size_t t, const ComplexVector& merged) const {
    const auto& [a, b, c] = triangles_[t];
    if (orientation(merged[a], merged[b], merged[c]) < 0) return {merged[a], merged[c], merged[b]};
    return {merged[a], merged[b], merged[c]};
  }
  static double right_end(const std::array<Complex, 3>& corners) {
    return std::max({corners[0].real(), corners[1].real(), corners[2].real()});
  }

  /// Whether no overlap with this triangle can be deep enough to count.
  bool covers_nothing(const PlaneTriangle& triangle) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (triangle.inwards[k] != 0.0 && std::abs(triangle.height[k]) <= resolution_ * triangle.reach) return true;
    }
    return orientation(triangle.corners[0], triangle.corners[1], triangle.corners[2]) == 0;
  }

  PlaneBox box_of(std::size_t t) const {
    const auto& [a, b, c] = triangles_[t];
    return PlaneBox::of({z_[a], z_[b], z_[c]});
  }

  const std::vector<std::array<int, 3>>& triangles_;
  const std::vector<int>& face_;
  double resolution_;
  ComplexVector z_;                           ///< empty if the map has no extent
  std::vector<std::pair<int, int>> stacked_;  ///< a triangle, and an omitted one that coincides with it
  std::vector<char> is_left_out_;  ///< per triangle: omitted from a stack, or covers nothing; empty if there are none
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
  for_each_polled(which.size(), [&](std::size_t i) {
    const auto& [a, b, c] = chart.triangles[static_cast<std::size_t>(which[i])];
    if (!chart.orientable) loose.push_back(static_cast<int>(triangles.size()));
    triangles.push_back({first + a, first + b, first + c});
    mirrored.push_back(is_mirrored ? 1 : 0);
  });
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
  return test.with(suspects);
}

std::vector<int> overlapping_faces(const Chart& chart, const ComplexVector& z, double resolution) {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face;
  const std::vector<int> mapped = mapped_triangulation(chart.triangles, chart.triangle_weights, z);
  for_each_polled(mapped.size(), [&](std::size_t i) {
    triangles.push_back(chart.triangles[static_cast<std::size_t>(mapped[i])]);
    face.push_back(chart.triangle_face[static_cast<std::size_t>(mapped[i])]);
  });
  std::vector<bool> overlapping;
  // Without a consistent orientation interior edges do not cancel.
  if (chart.orientable) {
    const std::vector<int> suspects = overlap_suspects(triangles, chart.boundary_loops, z);
    if (suspects.empty()) return {};
    overlapping = OverlapTest(triangles, z, face, resolution).with(suspects);
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
