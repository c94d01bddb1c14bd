#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "rebake/color_transfer.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("color_transfer");

TEST_CASE("the transfer function of sRGB has its published values, and its inverse") {
  CHECK(linear_from_srgb(0.04045) == doctest::Approx(0.0031308).epsilon(1e-4));
  CHECK(linear_from_srgb(0.5) == doctest::Approx(0.2140411).epsilon(1e-6));
  for (int k = 0; k <= 1000; ++k) CHECK(srgb_from_linear(linear_from_srgb(0.001 * k)) == doctest::Approx(0.001 * k));
  CHECK(srgb_from_linear(-1) == 0);
  CHECK(srgb_from_linear(2) == 1);
}

TEST_CASE("light is rounded to the nearest code") {
  const SrgbRounding rounding;
  for (int k = 0; k <= 20000; ++k) {
    const float light = static_cast<float>(k) / 20000;
    const double exact = 255 * srgb_from_linear(light);
    CHECK(std::abs(rounding(light) - exact) <= 0.5001);
  }
  for (int code = 0; code < 256; ++code) CHECK(rounding(static_cast<float>(linear_from_srgb(code / 255.0))) == code);
  CHECK(rounding(-1) == 0);
  CHECK(rounding(std::numeric_limits<float>::infinity()) == 255);
  CHECK(rounding(std::numeric_limits<float>::quiet_NaN()) == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
