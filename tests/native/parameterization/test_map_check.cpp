#include <doctest/doctest.h>

#include <limits>

#include "parameterization/map_check.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("map_check");

TEST_CASE("a map is rejected for the first condition that it violates") {
  const ComplexVector z = ComplexVector::Ones(4);
  MapCheck good;
  good.eigenvalue = 0.1;
  good.error = 1e-12;
  good.error_limit = 1e-10;
  good.area = 2;
  good.turning_number = 1;
  good.must_wind_once = true;
  CHECK(check_map(z, good) == Rejection::none);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ComplexVector broken = z;
  broken[2] = nan;
  CHECK(check_map(broken, good) == Rejection::not_finite);
  MapCheck check = good;
  check.eigenvalue = nan;
  CHECK(check_map(z, check) == Rejection::collapsed);
  check = good;
  for (const double error : {1e-10, nan}) {
    check.error = error;
    CHECK(check_map(z, check) == Rejection::unresolved);
  }
  check = good;
  for (const double area : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    check.area = area;
    check.may_be_mirrored = false;
    CHECK(check_map(z, check) == Rejection::no_area);
    check.may_be_mirrored = true;
    CHECK(check_map(z, check) == Rejection::none);
  }
  check = good;
  check.turning_number = -1;
  CHECK(check_map(z, check) == Rejection::none);
  for (const int turns : {0, 2, -3}) {
    check.turning_number = turns;
    check.must_wind_once = true;
    CHECK(check_map(z, check) == Rejection::winding);
    check.must_wind_once = false;
    CHECK(check_map(z, check) == Rejection::none);
  }
  check = good;
  check.folded = 0.2;
  CHECK(check_map(z, check) == Rejection::none);
  check.max_folded = 0.1;
  CHECK(check_map(z, check) == Rejection::folded);
  check.max_folded = 0.2;
  CHECK(check_map(z, check) == Rejection::none);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
