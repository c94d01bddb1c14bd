#include <doctest/doctest.h>

#include "graph/mixed_bits.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("mixed_bits");

TEST_CASE("the first numbers are those of SplitMix64 with seed 0") {
  CHECK(mixed_bits(golden_increment) == 0xe220a8397b1dcdafU);
  CHECK(mixed_bits(2 * golden_increment) == 0x6e789e6aa1b965f4U);
  CHECK(mixed_bits(3 * golden_increment) == 0x06c45d188009454fU);
}

TEST_CASE("pseudo-random numbers have mean 0 and variance 1/3") {
  double sum = 0;
  double squares = 0;
  constexpr int n = 10000;
  for (int k = 1; k <= n; ++k) {
    const double x = pseudo_random(static_cast<std::uint64_t>(k));
    CHECK((x >= -1 && x < 1));
    sum += x;
    squares += x * x;
  }
  // Within four standard deviations.
  CHECK(sum / n == doctest::Approx(0).epsilon(0.023));
  CHECK(squares / n == doctest::Approx(1.0 / 3).epsilon(0.036));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
