#include "geometry/segment_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"

namespace spectral_conformal {
namespace {

Complex twice_middle(const MovingSegment& segment) { return segment.from + segment.to; }

/// The range of numbers.
struct Range {
  double low = infinity;
  double high = -infinity;

  void include(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double size() const { return high - low; }
};

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
  const auto segment = [&](int i) -> const MovingSegment& {
    return segments[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
  };
  Complex longest = 0;
  for (int i = first; i < last; ++i) {
    const Complex side = segment(i).to - segment(i).from;
    if (std::norm(side) > std::norm(longest)) longest = side;
  }
  const Complex along = longest != Complex(0) ? longest : Complex(1);
  Node node{{}, Complex(0, 1) * along, std::abs(along), 0, order[static_cast<std::size_t>(first)], 0};
  Range lengthwise;
  std::array<Range, 2> middles;
  double largest = 0;
  for (int i = first; i < last; ++i) {
    const MovingSegment& s = segment(i);
    for (const auto& [place, motion] : {std::pair(s.from, s.from_motion), std::pair(s.to, s.to_motion)}) {
      node.extents[0].include(place.real(), motion.real());
      node.extents[1].include(place.imag(), motion.imag());
      node.extents[2].include(cross(along, place), cross(along, motion));
      lengthwise.include(dot(along, place));
      for (const Complex c : {place, motion}) largest = std::max({largest, std::abs(c.real()), std::abs(c.imag())});
    }
    middles[0].include(0.5 * dot(along, twice_middle(s)));
    middles[1].include(0.5 * cross(along, twice_middle(s)));
  }
  node.rounding = sum_rounding * largest * node.length;
  const auto index = static_cast<std::size_t>(nodes_.size());
  nodes_.push_back(node);
  poll(last - first);
  if (last - first == 1) return static_cast<int>(index);
  // Cut across what loses the larger part of its extent, which halves of long segments beside each other do not; among
  // segments as short as those of a border, what is longer.
  const double thickness = node.extents[2].high - node.extents[2].low;
  const double by_length = middles[0].size() * thickness;
  const double by_thickness = middles[1].size() * lengthwise.size();
  const bool is_alike = by_length <= 2 * by_thickness && by_thickness <= 2 * by_length;
  const bool across = is_alike ? middles[1].size() > middles[0].size() : by_thickness > by_length;
  const int middle = first + (last - first) / 2;
  // The index makes the order the same on every platform.
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last, [&](int a, int b) {
    const Complex middle_a = twice_middle(segments[static_cast<std::size_t>(a)]);
    const Complex middle_b = twice_middle(segments[static_cast<std::size_t>(b)]);
    const double place_a = across ? cross(along, middle_a) : dot(along, middle_a);
    const double place_b = across ? cross(along, middle_b) : dot(along, middle_b);
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
  return meets_along(node.extents[2], dot(node.normal, disk.center), dot(node.normal, disk.motion),
                     disk.radius * node.length + node.rounding);
}

}  // namespace spectral_conformal
