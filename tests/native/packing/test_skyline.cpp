#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "packing/skyline.h"

namespace spectral_conformal::test {
namespace {

/// The same by its definition: scans the whole border for each box.
class ScannedSkyline {
 public:
  explicit ScannedSkyline(double width) : width_(width), segments_{{0, 0, width}} {}

  void put(PackedBox& box) {
    std::size_t best = 0;
    double best_y = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < segments_.size() && segments_[i].x + box.width <= width_; ++i) {
      const double y = height_over(i, box.width);
      if (!(y < best_y)) continue;
      best = i;
      best_y = y;
    }
    box.x = segments_[best].x;
    box.y = std::isfinite(best_y) ? best_y : height_over(0, box.width);  // as wide as the strip, up to rounding
    const double end = box.x + box.width;
    std::size_t last = best;
    while (last < segments_.size() && segments_[last].end <= end) ++last;
    if (last < segments_.size()) segments_[last].x = std::max(segments_[last].x, end);
    const auto at = segments_.begin();
    segments_.insert(segments_.erase(at + static_cast<std::ptrdiff_t>(best), at + static_cast<std::ptrdiff_t>(last)),
                     Segment{box.x, box.y + box.height, end});
  }

 private:
  struct Segment {
    double x;
    double y;
    double end;
  };
  double height_over(std::size_t i, double width) const {
    const double end = segments_[i].x + width;
    double y = segments_[i].y;
    for (std::size_t j = i + 1; j < segments_.size() && segments_[j].x < end; ++j) y = std::max(y, segments_[j].y);
    return y;
  }

  double width_;
  std::vector<Segment> segments_;
};

/// Puts boxes of random sizes into strips of both kinds, and demands the same places.
template <class Width, class Height>
void check_equal(unsigned seed, double strip, const Width& width, const Height& height) {
  std::mt19937 generator(seed);
  const auto chance = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  Skyline skyline(strip);
  ScannedSkyline scanned(strip);
  int differ = 0;
  for (int k = 0; k < 1500; ++k) {
    PackedBox box{0, 0, width(chance()), height(chance())};
    PackedBox same = box;
    skyline.put(box);
    scanned.put(same);
    if (box.x != same.x || box.y != same.y) ++differ;
  }
  CHECK(differ == 0);
}

}  // namespace

TEST_SUITE_BEGIN("skyline");

TEST_CASE("a skyline puts every box where a scan of the whole border does") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const auto any = [](double c) { return c; };
    check_equal(seed, 30, any, any);
    check_equal(seed, 1, any, any);
    // Narrow wells beside wide boxes.
    const auto uneven = [](double c) { return 0.01 / (0.002 + c); };
    check_equal(seed, 9, uneven, any);
    check_equal(seed, 9, uneven, uneven);
    // Many equal heights and runs, widths that fill the strip but for rounding, boxes without width or height.
    const auto of_ten = [](double c) { return 0.1 * std::floor(4 * c); };
    check_equal(seed, 1, of_ten, of_ten);
    check_equal(seed, 0.3, of_ten, of_ten);
    check_equal(seed, 0.1 * 3, of_ten, any);
    check_equal(
        seed, 0, [](double) { return 0.0; }, any);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
