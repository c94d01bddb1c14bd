#include <doctest/doctest.h>

#include <algorithm>

#include "geometry/nearest_point.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

int nearest_of_all(const std::vector<Complex>& points, Complex place) {
  const auto nearer = [place](Complex a, Complex b) { return std::norm(a - place) < std::norm(b - place); };
  return static_cast<int>(std::min_element(points.begin(), points.end(), nearer) - points.begin());
}

}  // namespace

TEST_SUITE_BEGIN("nearest_point");

TEST_CASE("the nearest of scattered points is that of a search through all") {
  const ComplexVector random = random_map(300);
  std::vector<Complex> points(random.begin(), random.end());
  points.insert(points.end(), points.begin(), points.begin() + 50);  // the first of equal ones is named
  const NearestPoint nearest = NearestPoint::among(points);
  for (const Complex p : random_map(1000)) CHECK(nearest.to(1.5 * p) == nearest_of_all(points, 1.5 * p));
  for (const Complex p : points) CHECK(nearest.to(p) == nearest_of_all(points, p));
}

TEST_CASE("points in a line, of a grid, alone") {
  std::vector<Complex> points;
  for (int k = 0; k < 40; ++k) points.emplace_back(0.5, k % 7);
  for (int k = 0; k < 49; ++k) points.emplace_back(k / 7, k % 7);
  const NearestPoint nearest = NearestPoint::among(points);
  for (int k = 0; k < 400; ++k) {
    const Complex place(0.5 * (k % 20) - 1, 0.5 * (k / 20) - 1);
    CHECK(nearest.to(place) == nearest_of_all(points, place));
  }
  CHECK(NearestPoint::among({Complex(3, 4)}).to(0) == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
