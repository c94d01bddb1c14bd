#include <doctest/doctest.h>

#include <cmath>

#include "seams/seam_price.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("seam_price");

TEST_CASE("seams cost most across a flat region, their length at 20 degrees, and least along sharp edges") {
  const auto folded_by = [](double degrees) { return seam_price(degrees * M_PI / 180, false); };
  CHECK(folded_by(0) == doctest::Approx(2));
  CHECK(folded_by(20) == doctest::Approx(1));
  CHECK(folded_by(90) == folded_by(120));
  double before = 2.1;
  for (double degrees = 0; degrees <= 90; degrees += 5) {
    const double price = folded_by(degrees);
    CHECK(price <= before);
    CHECK(price > 0);
    before = price;
  }
}

TEST_CASE("concave edges cost less than convex ones, unless both are flat or sharp") {
  CHECK(seam_price(0, true) == seam_price(0, false));
  CHECK(seam_price(0.3, true) < seam_price(0.3, false));
  CHECK(seam_price(0.3, true) == doctest::Approx(seam_price(0.6, false)));
  CHECK(seam_price(2, true) == seam_price(2, false));
}

TEST_CASE("a mark takes the price to that of the sharpest edge, by its strength") {
  CHECK(marked_price(2, 0) == 2);
  CHECK(marked_price(2, 1) == doctest::Approx(seam_price(2, false)));
  CHECK(marked_price(1.6, 0.5) == doctest::Approx(0.4));
  CHECK(marked_price(0.1, 0.3) == doctest::Approx(0.1));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
