#include "layout/skyline.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "concurrency/listening.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {
void Skyline::put(PackedBox& box) {
  std::size_t best = segments_.size();
  double best_y = infinity;
  for (std::size_t i = 0; i < segments_.size() && segments_[i].x + box.width <= width_; ++i) {
    const double y = height_over(i, box.width);
    if (y < best_y) {
      best = i;
      best_y = y;
    }
  }
  // A box as wide as the strip, up to rounding.
  if (best == segments_.size()) {
    best = 0;
    best_y = height_over(0, box.width);
  }
  still_working(10.0 * static_cast<double>(segments_.size()));
  box.x = segments_[best].x;
  box.y = best_y;
  raise(best, box);
}

void Skyline::raise(std::size_t i, const PackedBox& box) {
  const double end = box.x + box.width;
  std::size_t last = i;
  while (last < segments_.size() && segments_[last].end <= end) ++last;
  const Segment raised{box.x, box.y + box.height, end};
  if (last < segments_.size()) segments_[last].x = std::max(segments_[last].x, end);
  if (last > i) {
    segments_[i] = raised;
    segments_.erase(segments_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                    segments_.begin() + static_cast<std::ptrdiff_t>(last));
  } else {
    segments_.insert(segments_.begin() + static_cast<std::ptrdiff_t>(i), raised);
  }
}

SkylineTree::SkylineTree(const Skyline& skyline) : segments_{{0, infinity, 0}, {skyline.width(), infinity, infinity}} {
  segments_[left_end].behind = right_end;
  segments_[right_end].before = left_end;
  along_.insert_before(MaxTreap::none, left_end, infinity);
  along_.insert_before(MaxTreap::none, right_end, infinity);
  for (const auto& [x, y, end] : skyline.segments()) insert_before(right_end, x, y, end);
}

void SkylineTree::put(PackedBox& box) {
  Run run = lowest_run(box.width);
  if (run.first == MaxTreap::none) {
    // A box as wide as the strip, up to rounding.
    run.first = segment(left_end).behind;
    run.y = segment(run.first).y;
    const double end = segment(run.first).x + box.width;
    for (int i = run.first; i != right_end && segment(i).x < end; i = segment(i).behind) {
      run.y = std::max(run.y, segment(i).y);
    }
  }
  box.x = segment(run.first).x;
  box.y = run.y;
  raise(run.first, box);
}

SkylineTree::Run SkylineTree::lowest_run(double width) {
  const double strip = segment(right_end).x;
  for (;;) {
    still_working(500);
    const int i = by_height_.first_above(width);
    if (i == MaxTreap::none) return {};
    const double y = segment(i).y;
    const int first = segment(along_.previous_above(i, y)).behind;
    const double begin = segment(first).x;
    const double end = segment(along_.next_above(i, y)).x;
    if (begin + width <= std::min(end, strip)) return {first, y};
    // Nothing wider fits either. Anything that fits exceeds this bound despite rounding.
    by_height_.set_value(i, std::min(width, end - begin + sum_rounding * strip));
  }
}

void SkylineTree::insert_before(int at, double x, double y, double end) {
  const int i = static_cast<int>(segments_.size());
  const int before = segment(at).before;
  segments_.push_back({x, y, end, before, at});
  segment(before).behind = i;
  segment(at).before = i;
  along_.insert_before(at, i, y);
  const int next = by_height_.first_behind(
      [&](int other) { return segment(other).y > y || (segment(other).y == y && segment(other).x > x); });
  by_height_.insert_before(next, i, infinity);
}

void SkylineTree::erase(int i) {
  segment(segment(i).before).behind = segment(i).behind;
  segment(segment(i).behind).before = segment(i).before;
  along_.erase(i);
  by_height_.erase(i);
}

void SkylineTree::raise(int first, const PackedBox& box) {
  const double end = box.x + box.width;
  int last = first;
  while (last != right_end && segment(last).end <= end) {
    const int behind = segment(last).behind;
    erase(last);
    last = behind;
  }
  if (last != right_end) segment(last).x = std::max(segment(last).x, end);
  insert_before(last, box.x, box.y + box.height, end);
}

}  // namespace spectral_conformal
