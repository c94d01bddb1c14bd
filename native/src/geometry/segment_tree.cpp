#include "geometry/segment_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/plane_box.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

Complex twice_middle(const MovingSegment& segment) { return segment.from + segment.to; }

}  // namespace

void SegmentTree::Extent::include(double place, double motion) {
  low = std::min(low, place);
  high = std::max(high, place);
  slowest = std::min(slowest, motion);
  fastest = std::max(fastest, motion);
}

SegmentTree SegmentTree::over(const std::vector<MovingSegment>& segments) {
  SegmentTree tree;
  std::vector<int> order(segments.size());
  std::iota(order.begin(), order.end(), 0);
  tree.nodes_.reserve(2 * segments.size());
  if (!segments.empty()) tree.build(segments, order, 0, static_cast<int>(segments.size()));
  return tree;
}

int SegmentTree::build(const std::vector<MovingSegment>& segments, std::vector<int>& order, int first, int last) {
  const auto for_each_end = [&](const auto& visit) {
    for (int i = first; i < last; ++i) {
      const MovingSegment& segment = segments[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
      visit(segment.from, segment.from_motion);
      visit(segment.to, segment.to_motion);
    }
  };
  const auto for_each_segment = [&](const auto& visit) {
    for (int i = first; i < last; ++i) visit(segments[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])]);
  };
  Node node{};
  node.index = order[static_cast<std::size_t>(first)];
  Extent& x = node.extents[0];
  Extent& y = node.extents[1];
  Extent& across = node.extents[2];
  for_each_end([&](Complex place, Complex motion) {
    x.include(place.real(), motion.real());
    y.include(place.imag(), motion.imag());
  });
  const Complex size(x.high - x.low, y.high - y.low);
  Complex longest = 0;
  for_each_segment([&](const MovingSegment& segment) {
    const Complex side = segment.to - segment.from;
    if (std::norm(side) > std::norm(longest)) longest = side;
  });
  Complex direction = size.real() >= size.imag() ? Complex(1) : Complex(0, 1);
  // A slab along shorter ones, as those of a border are, holds no less than the box.
  if (std::norm(longest) > 0.25 * std::norm(size)) {
    node.normal = Complex(0, 1) * longest;
    node.length = std::abs(longest);
    PlaneBox ends;
    PlaneBox middles;
    for_each_segment([&](const MovingSegment& segment) {
      across.include(cross(longest, segment.from), cross(longest, segment.from_motion));
      across.include(cross(longest, segment.to), cross(longest, segment.to_motion));
      ends.include(std::conj(longest) * segment.from);
      ends.include(std::conj(longest) * segment.to);
      middles.include(0.5 * std::conj(longest) * twice_middle(segment));
    });
    double largest = 0;
    for (const Extent& extent : {x, y}) {
      for (const double end : {extent.low, extent.high, extent.slowest, extent.fastest}) {
        largest = std::max(largest, std::abs(end));
      }
    }
    node.rounding = sum_rounding * largest * node.length;
    // Cut where the parts are the smallest: halves of long segments beside each other are hardly shorter.
    const double by_length = middles.size().real() * (across.high - across.low);
    const double by_width = middles.size().imag() * ends.size().real();
    direction = by_width > by_length ? node.normal : longest;
  }
  const auto index = static_cast<std::size_t>(nodes_.size());
  nodes_.push_back(node);
  poll(last - first);
  if (last - first == 1) return static_cast<int>(index);
  const int middle = first + (last - first) / 2;
  // The index makes the order the same on every platform.
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last, [&](int a, int b) {
    const double place_a = dot(direction, twice_middle(segments[static_cast<std::size_t>(a)]));
    const double place_b = dot(direction, twice_middle(segments[static_cast<std::size_t>(b)]));
    return place_a != place_b ? place_a < place_b : a < b;
  });
  build(segments, order, first, middle);
  const int second = build(segments, order, middle, last);
  nodes_[index].second_child = second;
  return static_cast<int>(index);
}

bool SegmentTree::meets(const Node& node, const MovingDisk& disk) {
  double begin = 0;
  double end = 1;
  // Reduces the time to that in which a gap, which grows by `growth`, is closed.
  const auto reduce = [&](double gap, double growth) {
    if (growth < 0) {
      begin = std::max(begin, -gap / growth);
    } else if (gap > 0) {
      end = -1;
    } else if (growth > 0) {
      end = std::min(end, -gap / growth);
    }
    return begin <= end + sum_rounding;
  };
  const auto meets_along = [&](const Extent& extent, double place, double motion, double radius) {
    return reduce(extent.low - (place + radius), extent.slowest - motion) &&
           reduce((place - radius) - extent.high, motion - extent.fastest);
  };
  if (!meets_along(node.extents[0], disk.center.real(), disk.motion.real(), disk.radius)) return false;
  if (!meets_along(node.extents[1], disk.center.imag(), disk.motion.imag(), disk.radius)) return false;
  if (node.length == 0) return true;
  return meets_along(node.extents[2], dot(node.normal, disk.center), dot(node.normal, disk.motion),
                     disk.radius * node.length + node.rounding);
}

}  // namespace spectral_conformal
