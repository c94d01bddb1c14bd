#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "geometry/point_merging.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("point_merging");

TEST_CASE("points about some places become these places' first ones, no point moves by half its tolerance") {
  std::mt19937 generator(2);
  const auto chance = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  constexpr int n = 500;
  constexpr double tolerance = 2e-3;
  ComplexVector points(n);
  for (int i = 0; i < n; ++i)
    points[i] = Complex(i % 7, i % 3) + std::polar(0.24 * tolerance * chance(), 2 * pi * chance());
  const ComplexVector merged = merge_points(points, std::vector<double>(n, tolerance));
  for (int i = 0; i < n; ++i) {
    CHECK(merged[i] == points[i % 21]);
    CHECK(std::abs(merged[i] - points[i]) < 0.5 * tolerance);
  }
}

TEST_CASE("points in a dense row move to the next before them that does not move") {
  constexpr int n = 100;
  ComplexVector points(n);
  for (int i = 0; i < n; ++i) points[i] = Complex(i, 0);
  const ComplexVector merged = merge_points(points, std::vector<double>(n, 5.2));
  for (int i = 0; i < n; ++i) CHECK(merged[i] == Complex(i - i % 3, 0));
}

TEST_CASE("points apart, or without tolerance, stay; equal ones stay equal") {
  ComplexVector points(4);
  points << Complex(1, 2), Complex(1, 2), Complex(1, 2.001), Complex(-1, 0);
  CHECK(merge_points(points, {0, 0, 0, 0}) == points);
  CHECK(merge_points(points, {1e-4, 1e-4, 1e-4, 1e-4}) == points);
  CHECK(merge_points(ComplexVector(), {}).size() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
