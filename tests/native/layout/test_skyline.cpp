#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <random>

#include "layout/skyline.h"

namespace spectral_conformal::test {
namespace {

/// Puts boxes of random sizes into strips of both kinds, and demands the same places.
template <class Width, class Height>
void check_equal(unsigned seed, double strip, const Width& width, const Height& height) {
  std::mt19937 generator(seed);
  const auto chance = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  Skyline skyline(strip);
  std::optional<SkylineTree> tree(skyline);
  int differ = 0;
  for (int k = 0; k < 1500; ++k) {
    if (k == 700) tree.emplace(skyline);  // begins anew with what is there
    PackedBox box{0, 0, width(chance()), height(chance())};
    PackedBox same = box;
    skyline.put(box);
    tree->put(same);
    if (box.x != same.x || box.y != same.y) ++differ;
  }
  CHECK(differ == 0);
}

}  // namespace

TEST_SUITE_BEGIN("skyline");

TEST_CASE("the tree puts every box where the list does") {
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
