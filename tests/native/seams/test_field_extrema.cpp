#include <doctest/doctest.h>

#include "seams/field_extrema.h"

namespace spectral_conformal::test {
namespace {

/// A fan-free strip whose vertices 0, 1, ... lie beside each other, so that the function is one of one variable.
Adjacency strip(int n) {
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i + 2 < n; ++i) triangles.push_back({i, i + 1, i + 2});
  return neighbors_along(triangles, n);
}

}  // namespace

TEST_SUITE_BEGIN("field_extrema");

TEST_CASE("prominence and volume of two basins") {
  // Steps of two, because every vertex of the strip also neighbors the one after the next.
  const std::vector<double> field{0, 0, -5, -5, -1, -1, -3, -3, 0, 0};
  const std::vector<double> area{1, 1, 1, 1, 1, 1, 2, 1, 1, 1};
  const auto minima = prominent_minima(field, area, strip(10), 0, 0.5);
  REQUIRE(minima.size() == 2);
  CHECK(minima[0].vertex == 2);
  CHECK(minima[0].prominence == doctest::Approx(5));
  CHECK(minima[0].volume == doctest::Approx(5 + 5 + 1 + 1 + 2 * 3 + 3));
  CHECK(minima[1].vertex == 6);
  CHECK(minima[1].prominence == doctest::Approx(2));
  CHECK(minima[1].volume == doctest::Approx(2 * 2 + 2));
}

TEST_CASE("shallow minima and values above the top are left out") {
  const std::vector<double> field{0, 0, -5, -5, -2.9, -2.9, -3, -3, 1, 1};
  const std::vector<double> area(10, 1.0);
  CHECK(prominent_minima(field, area, strip(10), 0, 0.5).size() == 1);
  CHECK(prominent_minima(field, area, strip(10), 0, 0.05).size() == 2);
  CHECK(prominent_minima(field, area, strip(10), -6, 0).empty());
}

TEST_CASE("a basin of a speck of area comes last, however deep") {
  const std::vector<double> field{0, 0, -9, -9, 0, 0, -3, -3, 0, 0};
  std::vector<double> area(10, 1.0);
  area[2] = area[3] = 1e-3;
  const auto minima = prominent_minima(field, area, strip(10), 0, 0.5);
  REQUIRE(minima.size() == 2);
  CHECK(minima[0].vertex == 6);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
