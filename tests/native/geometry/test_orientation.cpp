#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "geometry/orientation.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("orientation");

TEST_CASE("the sign is that of the turn, at every size") {
  for (const double unit : {1.0, 1e-200, 1e200, std::numeric_limits<double>::denorm_min()}) {
    const Complex a(0, 0), b(unit, 0), c(unit, unit);
    CHECK(orientation(a, b, c) == 1);
    CHECK(orientation(b, c, a) == 1);
    CHECK(orientation(a, c, b) == -1);
    CHECK(orientation(a, b, 0.0) == 0);
    CHECK(orientation(a, a, c) == 0);
  }
}

TEST_CASE("the sign is exact where rounding decides on the area") {
  // Points next to the line y = x through 12 and 24 (Kettner et al. 2008, Classroom examples of robustness problems).
  const double step = std::ldexp(1.0, -53);
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Complex p(0.5 + i * step, 0.5 + j * step);
      const int expected = p.imag() > p.real() ? 1 : p.imag() < p.real() ? -1 : 0;
      CHECK(orientation({12, 12}, {24, 24}, p) == expected);
      CHECK(orientation(p, {24, 24}, {12, 12}) == -expected);
    }
  }
}

TEST_CASE("coordinates that are not finite are refused") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const Complex p : {Complex(bad, 0), Complex(0, bad), Complex(-bad, bad)}) {
      CHECK_THROWS_AS(orientation(p, 1.0, {0, 1}), SolveFailure);
      CHECK_THROWS_AS(orientation(1.0, p, {0, 1}), SolveFailure);
      CHECK_THROWS_AS(orientation(1.0, {0, 1}, p), SolveFailure);
      CHECK_THROWS_AS(orientation(p, p, p), SolveFailure);
    }
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
