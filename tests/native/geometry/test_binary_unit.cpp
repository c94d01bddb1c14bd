#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "geometry/binary_unit.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("binary_unit");

TEST_CASE("the largest coordinate is between a half and one in it, and back in the input's units unchanged") {
  for (const double size : {1e-300, 3e-5, 1.0, 7.0, 1e200}) {
    BinaryUnit unit;
    for (const double x : {-size, 0.3 * size, 0.0}) unit.include(x);
    const double scaled = unit.scaled(size);
    CHECK(scaled >= 0.5);
    CHECK(scaled < 1);
    CHECK(std::ldexp(scaled, unit.exponent()) == size);
    CHECK(unit.area_of(scaled * scaled) == size * size);
  }
}

TEST_CASE("of several units one can be made") {
  BinaryUnit small;
  BinaryUnit large;
  BinaryUnit nothing;
  small.include(0.75);
  large.include(-5);
  BinaryUnit unit = small;
  unit.include(nothing);
  CHECK(unit.exponent() == 0);
  unit.include(large);
  CHECK(unit.exponent() == large.exponent());
  unit.include(small);
  CHECK(unit.exponent() == 3);
}

TEST_CASE("without a coordinate other than zero, or with ones that are not finite only, it is one") {
  BinaryUnit unit;
  for (const double x : {0.0, std::numeric_limits<double>::infinity(), std::nan("")}) unit.include(x);
  CHECK(unit.exponent() == 0);
  CHECK(unit.scaled(3) == 3);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
