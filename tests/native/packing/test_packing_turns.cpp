#include <doctest/doctest.h>

#include <algorithm>

#include "packing/packing_turns.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("packing_turns");

TEST_CASE("turns have length 1, are all different, and one of them lays a slanted rectangle along the axes") {
  const Complex slanted = std::polar(1.0, 0.3);
  const std::vector<Complex> hull{0, 4.0 * slanted, Complex(4, 1) * slanted, Complex(0, 1) * slanted};
  CHECK(turns_of(hull, PackingTurns::none, 16) == std::vector<Complex>{1});
  CHECK(turns_of(hull, PackingTurns::quarters, 16).size() == 4);
  const std::vector<Complex> turns = turns_of(hull, PackingTurns::free, 16);
  REQUIRE(turns.size() == 16);
  for (std::size_t k = 0; k < 16; ++k) {
    CHECK(std::abs(turns[k]) == doctest::Approx(1));
    CHECK(std::abs(turns[k] / turns[(k + 15) % 16] - std::polar(1.0, pi / 8)) < 1e-12);
  }
  const Complex side = turns.front() * slanted;
  CHECK(std::min(std::abs(side.real()), std::abs(side.imag())) < 1e-12);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
