#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/segment_tree.h"
#include "geometry/signed_area.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

std::vector<int> segments_met(const SegmentTree& tree, const MovingDisk& disk) {
  std::vector<int> found;
  tree.for_each_meeting(disk, [&](int index) {
    found.push_back(index);
    return true;
  });
  std::sort(found.begin(), found.end());
  return found;
}

bool meets_at(double time, const MovingDisk& disk, const MovingSegment& segment) {
  const Complex from = segment.from + time * segment.from_motion;
  const Complex side = segment.to + time * segment.to_motion - from;
  const Complex arm = disk.center + time * disk.motion - from;
  const double position = std::norm(side) > 0 ? std::clamp(dot(side, arm) / std::norm(side), 0.0, 1.0) : 0.0;
  return std::abs(arm - position * side) <= disk.radius;
}

/// Segments of random places and lengths, some of no length.
std::vector<MovingSegment> random_segments(int n, double length, double motion, unsigned seed) {
  const ComplexVector random = random_map(4 * n, seed);
  std::vector<MovingSegment> segments;
  for (int i = 0; i < n; ++i) {
    const Complex side = i % 5 == 0 ? 0 : length * random[4 * i + 1];
    segments.push_back({random[4 * i], random[4 * i] + side, motion * random[4 * i + 2], motion * random[4 * i + 3]});
  }
  return segments;
}

}  // namespace

TEST_SUITE_BEGIN("segment_tree");

TEST_CASE("finds all segments that a disk meets at some time, and few others") {
  const ComplexVector disks = random_map(80, 7);
  for (const int n : {1, 4, 17, 300}) {
    for (const double length : {0.02, 2.0}) {
      for (const double motion : {0.0, 0.3}) {
        const std::vector<MovingSegment> segments = random_segments(n, length, motion, static_cast<unsigned>(n));
        const SegmentTree tree = SegmentTree::over(segments);
        int n_others = 0;
        for (int d = 0; d < 40; ++d) {
          const MovingDisk disk{disks[2 * d], 0.02 * (d % 3), motion * disks[2 * d + 1]};
          const std::vector<int> found = segments_met(tree, disk);
          for (int k = 0; k < n; ++k) {
            bool meets = false;
            for (int t = 0; t <= 100; ++t) meets = meets || meets_at(0.01 * t, disk, segments[k]);
            const bool is_found = std::binary_search(found.begin(), found.end(), k);
            if (meets) CHECK(is_found);
            n_others += is_found && !meets ? 1 : 0;
          }
        }
        CHECK(n_others <= (motion > 0 ? 0.15 : 0.01) * 40 * n);
      }
    }
  }
}

TEST_CASE("a point on a segment meets it, however the segment is turned and long") {
  for (int k = 0; k < 100; ++k) {
    const Complex side = std::polar(std::pow(10.0, k % 9), 0.1 + k);
    const SegmentTree tree = SegmentTree::over({{1, 1.0 + side, 0, 0}});
    CHECK(segments_met(tree, {1.0 + 0.01 * k * side}) == std::vector<int>{0});
    CHECK(segments_met(tree, {1.0 + 0.01 * k * side + 1e-3 * Complex(0, 1) * side}).empty());
  }
}

TEST_CASE("what moves alike does not meet, what moves together does") {
  const MovingSegment still{0, {1, 1}, 0, 0};
  MovingSegment fast = still;
  fast.from_motion = fast.to_motion = {100, -50};
  const auto meets = [](const MovingSegment& segment, const MovingDisk& disk) {
    return !segments_met(SegmentTree::over({segment}), disk).empty();
  };
  CHECK_FALSE(meets(still, {{1, 0}, 0.5}));
  CHECK(meets(still, {{1, 0}, 0.5, {-1, 0}}));
  CHECK_FALSE(meets(fast, {{1, 0}, 0.5, {100, -50}}));
}

TEST_CASE("of long segments beside each other, few are visited") {
  // Rays, whose boxes nearly all meet.
  constexpr int n = 4000;
  const ComplexVector random = random_map(n, 3);
  std::vector<MovingSegment> rays;
  for (int k = 0; k < n; ++k) {
    const Complex direction = std::polar(1.0, 0.5 * pi * k / n);
    rays.push_back({(0.5 + 0.2 * random[k].real()) * direction, direction, 0, 0});
  }
  const SegmentTree tree = SegmentTree::over(rays);
  for (int k = 0; k < 100; ++k) CHECK(segments_met(tree, {std::polar(0.9, 0.015 * k), 1e-4}).size() <= 3);
}

TEST_CASE("stops when told to, and many equal segments are no trouble") {
  const SegmentTree tree = SegmentTree::over(std::vector<MovingSegment>(10000, {0, {1, 1}, 0, 0}));
  int calls = 0;
  tree.for_each_meeting({{0.5, 0.5}}, [&](int) { return ++calls < 3; });
  CHECK(calls == 3);
  CHECK(segments_met(tree, {{1, 1}}).size() == 10000);
}

TEST_CASE("no segments") { CHECK(segments_met(SegmentTree::over({}), {0, 1}).empty()); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test
