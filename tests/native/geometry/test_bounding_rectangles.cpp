#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "geometry/bounding_rectangles.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

std::vector<Complex> random_points(Eigen::Index n) {
  const ComplexVector points = random_map(n);
  return {points.begin(), points.end()};
}

std::vector<Complex> regular_polygon(int n) {
  std::vector<Complex> corners;
  corners.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) corners.push_back(std::polar(1.0, 0.3 + 2 * pi * k / n));
  return corners;
}

double area(const Rectangle& r) { return r.width * r.height; }

}  // namespace

TEST_SUITE_BEGIN("bounding_rectangles");

TEST_CASE("all points lie left of every edge of their hull, whose corners are among them") {
  const std::vector<Complex> points = random_points(200);
  const std::vector<Complex> hull = convex_hull(points);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    CHECK(std::count(points.begin(), points.end(), hull[i]) == 1);
    const Complex edge = hull[(i + 1) % hull.size()] - hull[i];
    for (const Complex p : points) CHECK(std::imag(std::conj(edge) * (p - hull[i])) >= -1e-15);
  }
}

TEST_CASE("points in a line have their ends as hull, equal points themselves") {
  CHECK(convex_hull({Complex(1, 1), 0.0, Complex(2, 2), Complex(1, 1)}) == std::vector<Complex>{0.0, Complex(2, 2)});
  CHECK(convex_hull({1.0, 1.0}) == std::vector<Complex>{1.0});
  const std::vector<Rectangle> line = smallest_rectangles({0.0, Complex(3, 4)}, 0.01);
  CHECK((line.size() == 1 && line[0].width == doctest::Approx(5) && line[0].height == 0));
  CHECK(smallest_rectangles({1.0}, 0.01).size() == 1);
}

TEST_CASE("points that are nearly in a line have rectangles, none of negative size") {
  // By rounding, the third lies on the wrong side of the others' line.
  const std::vector<Complex> line = {{-0x1.1e63db6843119p-2, -0x1.5ec3db6001641p-2},
                                     {0x1.eeda4c5520346p-2, 0x1.2f0b069666a8fp-1},
                                     {0x1.e3333377ef906p-2, 0x1.27e834a4524a6p-1}};
  const std::vector<Rectangle> found = smallest_rectangles(convex_hull(line), 1e-6);
  REQUIRE(!found.empty());
  for (const Rectangle& r : found) CHECK((r.width >= 0 && r.height >= 0));
}

TEST_CASE("a bounding rectangle is as wide and high as the turned points") {
  const std::vector<Complex> hull = {0.0, 4.0, Complex(4, 1), Complex(0, 1)};
  const Rectangle along = bounding_rectangle(hull, Complex(0, 1));
  CHECK((along.width == doctest::Approx(1) && along.height == doctest::Approx(4)));
  const Rectangle diagonal = bounding_rectangle(hull, std::polar(1.0, pi / 4));
  CHECK(diagonal.width == doctest::Approx(5 / std::sqrt(2.0)));
}

TEST_CASE("no direction has a rectangle smaller than the smallest ones, none of which is beyond the tolerance") {
  const std::vector<Complex> hull = convex_hull(random_points(60));
  for (const double tolerance : {0.0, 0.2}) {
    const std::vector<Rectangle> found = smallest_rectangles(hull, tolerance);
    double smallest = 1e9;
    for (int k = 0; k < 720; ++k) {
      smallest = std::min(smallest, area(bounding_rectangle(hull, std::polar(1.0, k * pi / 720))));
    }
    REQUIRE(!found.empty());
    for (const Rectangle& r : found) {
      CHECK(area(r) <= smallest * (1 + tolerance) * (1 + 1e-9));
      const Rectangle same = bounding_rectangle(hull, r.direction);
      CHECK((same.width == doctest::Approx(r.width) && same.height == doctest::Approx(r.height)));
    }
  }
}

TEST_CASE("of a regular outline all equal rectangles are found") {
  for (const int n : {3, 4, 6, 24}) CHECK(smallest_rectangles(convex_hull(regular_polygon(n)), 1e-9).size() == n);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
