#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "geometry/plane_box.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("plane_box");

TEST_CASE("the box of points is the smallest that holds them") {
  const PlaneBox box = PlaneBox::of({{1, 5}, {-2, 3}, {0, 7}});
  CHECK(box.low == std::array<double, 2>{-2, 3});
  CHECK(box.high == std::array<double, 2>{1, 7});
  const PlaneBox point = PlaneBox::of({{1, 5}});
  CHECK(point.low == point.high);
}

TEST_CASE("a box grows by points, and has a middle and a size") {
  PlaneBox box = PlaneBox::of(std::vector<Complex>{{1, 5}});
  CHECK_FALSE(box.meets(PlaneBox{}));
  box.include(Complex(-2, 7));
  CHECK(box.low_corner() == Complex(-2, 5));
  CHECK(box.high_corner() == Complex(1, 7));
  CHECK(box.middle() == Complex(-0.5, 6));
  CHECK(box.size() == Complex(3, 2));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
