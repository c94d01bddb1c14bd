#include <doctest/doctest.h>

#include "geometry/signed_area.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("signed_area");

TEST_CASE("the cross product is antisymmetric, and positive for a turn to the left") {
  CHECK(cross(2.0, Complex(5, 3)) == 6);
  CHECK(cross(Complex(5, 3), 2.0) == -6);
  CHECK(cross(Complex(5, 3), Complex(10, 6)) == 0);
}

TEST_CASE("the area of a triangle is positive where it runs counterclockwise, wherever it begins") {
  const Complex a(1, 1), b(4, 1), c(2, 3);
  CHECK(signed_area(a, b, c) == 3);
  CHECK(signed_area(b, c, a) == 3);
  CHECK(signed_area(a, c, b) == -3);
}

TEST_CASE("the area of a map is that inside its boundary, whichever splits its quads have") {
  const Patch quads(quad_grid(4, 3));
  const ComplexVector z = random_map(quads.positions.rows());
  const double expected = shoelace_area(quads.outer(), z);
  CHECK(signed_area(quads.chart.triangles, quads.chart.triangle_weights, z) == doctest::Approx(expected));
  const Patch triangles(flat_grid(4, 3));
  const ComplexVector map = random_map(triangles.positions.rows());
  CHECK(signed_area(triangles.chart.triangles, {}, map) == doctest::Approx(shoelace_area(triangles.outer(), map)));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
