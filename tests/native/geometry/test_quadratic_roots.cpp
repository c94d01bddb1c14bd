#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/quadratic_roots.h"

namespace spectral_conformal::test {
namespace {

std::array<double, 2> sorted_roots(double c0, double c1, double c2) {
  std::array<double, 2> roots = quadratic_roots(c0, c1, c2);
  std::sort(roots.begin(), roots.end());
  return roots;
}

}  // namespace

TEST_SUITE_BEGIN("quadratic_roots");

TEST_CASE("both roots, of either sign, also where one is tiny beside the other") {
  CHECK(sorted_roots(6, -5, 1) == std::array<double, 2>{2, 3});
  CHECK(sorted_roots(-6, 1, 1) == std::array<double, 2>{-3, 2});
  const auto [tiny, large] = sorted_roots(1, -1e9, 1);
  CHECK(tiny == doctest::Approx(1e-9).epsilon(1e-14));
  CHECK(large == doctest::Approx(1e9).epsilon(1e-14));
}

TEST_CASE("what has one root or none has infinite ones instead") {
  CHECK(std::isinf(sorted_roots(1, 0, 1)[0]));
  const auto [only, none] = sorted_roots(-4, 2, 0);
  CHECK(only == 2);
  CHECK(std::isinf(none));
  CHECK(std::isinf(sorted_roots(3, 0, 0)[0]));
}

TEST_CASE("the first root within a limit, or the limit") {
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(first_root(2, -3, 1, infinity) == doctest::Approx(1));
  CHECK(first_root(2, -3, 1, 5) == doctest::Approx(1));
  CHECK(first_root(2, -3, 1, 0.5) == 0.5);
  CHECK(first_root(2, 3, 1, infinity) == infinity);
  CHECK(first_root(2, 1, -1, infinity) == doctest::Approx(2));
  CHECK(first_root(1, -0.5, 0, infinity) == doctest::Approx(2));
  CHECK(first_root(1, 0, 0, infinity) == infinity);
  CHECK(first_root(1, -1, 1, 10) == 10);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
