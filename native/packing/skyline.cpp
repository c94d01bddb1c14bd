#include "packing/skyline.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

Skyline::Skyline(double width) : segments_{{0, infinity, 0}, {width, infinity, infinity}} {
  segments_[left_end].behind = right_end;
  segments_[right_end].before = left_end;
  along_.insert_before(MaxTreap::none, left_end, infinity);
  along_.insert_before(MaxTreap::none, right_end, infinity);
  insert_before(right_end, 0, 0, width);
}

void Skyline::put(PackedBox& box) {
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

Skyline::Run Skyline::lowest_run(double width) {
  const double strip = segment(right_end).x;
  for (;;) {
    poll();
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

void Skyline::insert_before(int at, double x, double y, double end) {
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

void Skyline::erase(int i) {
  segment(segment(i).before).behind = segment(i).behind;
  segment(segment(i).behind).before = segment(i).before;
  along_.erase(i);
  by_height_.erase(i);
}

void Skyline::raise(int first, const PackedBox& box) {
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
