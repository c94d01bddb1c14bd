#include "geometry/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <utility>

#include "geometry/box_tree.h"
#include "geometry/orientation.h"
#include "geometry/point_merging.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "geometry/triangle_sweep.h"

namespace spectral_conformal {
namespace {

/// The non-convex corners, in a tree. Clipping ears leaves convex corners convex.
struct Obstacles {
  std::vector<int> corners;
  BoxTree tree;
};

Obstacles obstacles_of(const std::vector<Complex>& outline) {
  std::vector<int> corners;
  std::vector<PlaneBox> boxes;
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (orientation(outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]) > 0) continue;
    corners.push_back(static_cast<int>(i));
    boxes.push_back(PlaneBox::of({outline[i]}));
  }
  return {std::move(corners), BoxTree::over(boxes)};
}

class EarClipping {
 public:
  EarClipping(const std::vector<Complex>& outline, double tolerance)
      : points_(outline),
        tolerance_(tolerance),
        n_left_(static_cast<int>(outline.size())),
        obstacles_(obstacles_of(outline)),
        waiting_(outline.size()) {
    for (int i = 0; i < n_left_; ++i) {
      previous_.push_back(i == 0 ? n_left_ - 1 : i - 1);
      next_.push_back(i + 1 == n_left_ ? 0 : i + 1);
    }
    for (int i = 0; i < n_left_; ++i) add_candidate(i);
  }

  std::vector<std::array<int, 3>> run() {
    while (n_left_ > 2) {
      if (candidates_.empty()) {
        clip(forced_ear());
        continue;
      }
      const int corner = candidates_.top().second;
      candidates_.pop();
      if (is_clipped(corner)) continue;
      if (is_spike(corner)) {
        clip(corner);
        continue;
      }
      if (turn(corner) <= 0) continue;  // until a neighbor is clipped
      const int blocker = find_blocker(corner, Contact::blocks);
      if (blocker < 0) {
        clip(corner);
      } else {
        waiting_[blocker].push_back(corner);
      }
    }
    return std::move(triangles_);
  }

 private:
  /// The effect of a corner on the sides of an ear: diagonals through corners are a last resort.
  enum class Contact { blocks, is_allowed };

  Complex point(int corner) const { return points_[static_cast<std::size_t>(corner)]; }
  int turn(int corner) const { return orientation(point(previous_[corner]), point(corner), point(next_[corner])); }
  bool is_clipped(int corner) const { return next_[corner] < 0; }
  /// Whether an edge of length 0 begins or ends there, or the outline turns back on itself.
  bool is_spike(int corner) const {
    const Complex back = point(previous_[corner]) - point(corner);
    const Complex on = point(next_[corner]) - point(corner);
    if (back == 0.0 || on == 0.0) return true;
    const double along = dot(back, on);
    const double between = std::abs(cross(back, on));
    // between / longer: the distance of the shorter edge's end from the other edge.
    const double longer = std::max(std::abs(back), std::abs(on));
    return between <= sum_rounding * along || (along > 0 && between <= tolerance_ * longer);
  }
  /// The side of the line from a to b on which p lies: 1 left, -1 right, 0 within the tolerance.
  int side(Complex a, Complex b, Complex p) const {
    if (tolerance_ == 0) return orientation(a, b, p);
    const double height = cross(b - a, p - a);
    return std::abs(height) <= tolerance_ * std::abs(b - a) ? 0 : height > 0 ? 1 : -1;
  }

  void add_candidate(int corner) {
    if (!is_clipped(corner)) candidates_.emplace(-std::norm(point(next_[corner]) - point(previous_[corner])), corner);
  }

  /// A non-convex corner that keeps a convex one from being an ear, or -1.
  int find_blocker(int corner, Contact contact) const {
    const int before = previous_[corner];
    const int after = next_[corner];
    const Complex a = point(before);
    const Complex b = point(corner);
    const Complex c = point(after);
    const auto is_between = [&](Complex p) { return orientation(b, c, p) > 0 && orientation(b, p, a) > 0; };
    PlaneBox box = PlaneBox::of({a, b, c});
    for (int axis = 0; axis < 2; ++axis) {
      box.low[axis] -= tolerance_;
      box.high[axis] += tolerance_;
    }
    int found = -1;
    obstacles_.tree.for_each_meeting(box, [&](int k) {
      const int other = obstacles_.corners[static_cast<std::size_t>(k)];
      if (is_clipped(other) || other == before || other == corner || other == after) return true;
      const Complex p = point(other);
      if (p == a || p == c || turn(other) > 0) return true;
      bool blocks = false;
      if (p == b) {
        // Edges that leave the same point into the ear.
        blocks = is_between(point(next_[other])) || is_between(point(previous_[other]));
      } else {
        const int least = std::min({side(a, b, p), side(b, c, p), side(c, a, p)});
        blocks = contact == Contact::blocks ? least >= 0 : least > 0;
      }
      if (blocks) found = other;
      return !blocks;
    });
    return found;
  }

  /// If no corner is clearly an ear: one whose diagonal touches others, or one without area, or any.
  int forced_ear() {
    while (is_clipped(start_)) ++start_;
    int flat = -1;
    int corner = start_;
    do {
      const int turned = turn(corner);
      if (turned > 0 && find_blocker(corner, Contact::is_allowed) < 0) return corner;
      if (turned == 0 && flat < 0) flat = corner;
      corner = next_[corner];
    } while (corner != start_);
    return flat < 0 ? start_ : flat;
  }

  void clip(int corner) {
    const int before = previous_[corner];
    const int after = next_[corner];
    triangles_.push_back({before, corner, after});
    next_[before] = after;
    previous_[after] = before;
    next_[corner] = -1;
    --n_left_;
    for (const int changed : {corner, before, after}) {
      if (changed != corner) add_candidate(changed);
      if (changed != corner && turn(changed) <= 0) continue;
      for (const int other : waiting_[changed]) add_candidate(other);
      waiting_[changed].clear();
    }
  }

  const std::vector<Complex>& points_;
  double tolerance_;
  int n_left_;
  Obstacles obstacles_;
  std::vector<int> previous_;
  std::vector<int> next_;                                   ///< -1: clipped
  std::priority_queue<std::pair<double, int>> candidates_;  ///< shortest diagonal first: few corners are near it
  std::vector<std::vector<int>> waiting_;  ///< per corner, those waiting for it to be clipped or become convex
  int start_ = 0;                          ///< of forced_ear
  std::vector<std::array<int, 3>> triangles_;
};

/// Whether all of `other` lies beyond one side of a counterclockwise triangle.
bool is_beyond_a_side(const std::array<Complex, 3>& triangle, const std::array<Complex, 3>& other, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Complex side = triangle[(k + 1) % 3] - triangle[k];
    const double limit = tolerance * std::abs(side);
    const auto is_beyond = [&](Complex p) { return cross(side, p - triangle[k]) <= limit; };
    if (std::all_of(other.begin(), other.end(), is_beyond)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::array<int, 3>> clip_ears(const std::vector<Complex>& outline, double tolerance) {
  return EarClipping(outline, tolerance).run();
}

bool covers_once(const std::vector<Complex>& points, const std::vector<std::array<int, 3>>& triangles,
                 double tolerance) {
  ComplexVector merged = Eigen::Map<const ComplexVector>(points.data(), static_cast<Eigen::Index>(points.size()));
  if (tolerance > 0) merged = merge_points(merged, std::vector<double>(points.size(), tolerance));
  std::vector<std::array<Complex, 3>> placed;
  std::vector<std::array<Complex, 3>> swept;
  for (const auto& [a, b, c] : triangles) {
    const std::array<Complex, 3> corners{points[a], points[b], points[c]};
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, std::abs(corners[(k + 1) % 3] - corners[k]));
    const double twice_area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (twice_area < -tolerance * longest) return false;
    if (twice_area <= tolerance * longest) continue;  // covers nothing
    placed.push_back(corners);
    swept.push_back({merged[a], merged[b], merged[c]});
  }
  const auto overlap = [&](std::size_t t, std::size_t other) {
    return !is_beyond_a_side(placed[t], placed[other], tolerance) &&
           !is_beyond_a_side(placed[other], placed[t], tolerance);
  };
  bool overlaps = false;
  std::vector<std::size_t> barely;  // meet another less deeply, so they are not swept together: test pair by pair
  sweep_triangles(swept, [&](int first, int second) {
    overlaps = overlap(static_cast<std::size_t>(first), static_cast<std::size_t>(second));
    const int out = std::max(first, second);
    barely.push_back(static_cast<std::size_t>(out));
    return overlaps ? -1 : out;
  });
  if (overlaps || barely.empty()) return !overlaps;
  std::vector<PlaneBox> boxes;
  boxes.reserve(placed.size());
  for (const auto& [a, b, c] : placed) boxes.push_back(PlaneBox::of({a, b, c}));
  const BoxTree tree = BoxTree::over(boxes);
  for (const std::size_t t : barely) {
    tree.for_each_meeting(boxes[t], [&](int k) {
      const auto other = static_cast<std::size_t>(k);
      overlaps = other != t && overlap(t, other);
      return !overlaps;
    });
    if (overlaps) return false;
  }
  return true;
}

}  // namespace spectral_conformal
