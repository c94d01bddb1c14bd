#include <doctest/doctest.h>

#include "geometry/plane_triangle.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("plane_triangle");

TEST_CASE("sides, heights and size are those of the corners") {
  const PlaneTriangle triangle({Complex(0, 0), Complex(4, 0), Complex(0, 3)});
  CHECK(triangle.size == doctest::Approx(5));
  CHECK(triangle.reach == doctest::Approx(4));
  CHECK(triangle.height[0] == doctest::Approx(3));
  CHECK(triangle.height[1] == doctest::Approx(12.0 / 5));
  CHECK(triangle.over_side(0, Complex(7, -2)) == doctest::Approx(-2));
  const PlaneTriangle clockwise({Complex(0, 0), Complex(0, 3), Complex(4, 0)});
  CHECK(clockwise.height[0] < 0);
}

TEST_CASE("a side separates triangles that have no more than the tolerance in common across it") {
  const PlaneTriangle one({Complex(0, 0), Complex(2, 0), Complex(0, 2)});
  const PlaneTriangle beside({Complex(2, 0), Complex(0, 0), Complex(1, -1)});
  const PlaneTriangle on_it({Complex(2, 0.1), Complex(0, 0.1), Complex(1, -1)});
  CHECK(separated_by_side(one, beside, 0));
  CHECK_FALSE(separated_by_side(one, on_it, 0));
  CHECK(separated_by_side(one, on_it, 0.11));
  CHECK(separated_by_side(one, PlaneTriangle({Complex(1, 1), Complex(1, 1), Complex(1, 1)}), 0));
}

TEST_CASE("triangles of a map overlap by more than rounding") {
  const auto at = [](double x) { return PlaneTriangle({Complex(x, 0), Complex(x + 1, 0), Complex(x, 1)}); };
  CHECK(overlap_by_more(at(0), at(0.5), 0.3));
  CHECK_FALSE(overlap_by_more(at(0), at(0.5), 0.4));
  CHECK(overlap_in_map(at(0), at(1 - 1e-4), 0));
  CHECK_FALSE(overlap_in_map(at(0), at(1 - 1e-15), 0));
  CHECK_FALSE(overlap_in_map(at(0), at(1 - 1e-4), 1e-3));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
