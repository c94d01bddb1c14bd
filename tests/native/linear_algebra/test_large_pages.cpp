#include <doctest/doctest.h>

#include <numeric>
#include <utility>

#include "linear_algebra/large_pages.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("large_pages");

TEST_CASE("all of an array can be written and read, whatever its size") {
  for (const std::size_t n : {1, 1000, 4'000'000, 4'194'304, 5'000'001}) {
    LargeVector<double> array(n);
    std::iota(array.begin(), array.end(), 0.0);
    const auto last = static_cast<double>(n - 1);
    CHECK(std::accumulate(array.begin(), array.end(), 0.0) == 0.5 * (last + 1) * last);
  }
}

TEST_CASE("an array grows, is copied, moved and given up as any vector") {
  LargeVector<double> array;
  for (int i = 0; i < 5'000'000; ++i) array.push_back(i);
  LargeVector<double> copy = array;
  LargeVector<double> moved = std::move(array);
  copy[4'999'999] = 7;
  CHECK(moved[4'999'999] == 4'999'999);
  moved = LargeVector<double>(10, 2.0);
  CHECK(moved.back() == 2);
  CHECK(LargePages<double>() == LargePages<double>());
}

TEST_CASE("more than there can be is refused") {
  LargePages<double> pages;
  CHECK_THROWS_AS(pages.allocate(static_cast<std::size_t>(-1) / 4), std::bad_alloc);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
