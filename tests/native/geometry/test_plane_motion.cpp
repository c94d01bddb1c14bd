#include <doctest/doctest.h>

#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("plane_motion");

TEST_CASE("a composed motion does one after the other, mirrored or not") {
  const Complex z(0.3, -1.2);
  for (const bool outer_mirrors : {false, true}) {
    for (const bool inner_mirrors : {false, true}) {
      const PlaneMotion outer{{0.5, 2}, outer_mirrors, {1, 3}};
      const PlaneMotion inner{{-1, 0.25}, inner_mirrors, {-2, 0.5}};
      CHECK(std::abs(composed(outer, inner)(z) - outer(inner(z))) < 1e-14);
    }
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
