#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "relaxation/distortion_measure.h"

namespace spectral_conformal::test {
namespace {

MapJacobian with_parts(Complex holomorphic, Complex antiholomorphic) {
  const double p = std::norm(holomorphic);
  const double q = std::norm(antiholomorphic);
  return {holomorphic, antiholomorphic, p + q, p - q};
}

}  // namespace

TEST_SUITE_BEGIN("distortion_measure");

TEST_CASE("each is the function of the singular values that it is said to be") {
  // s1 = 3, s2 = 1
  const MapJacobian j = with_parts({0, 2}, {-1, 0});
  CHECK(DistortionMeasure::symmetric_dirichlet.density(0, j).value == doctest::Approx(9 + 1 + 1 / 9.0 + 1));
  CHECK(DistortionMeasure::conformal.density(0, j).value == doctest::Approx(3 + 1 / 3.0));
  CHECK(DistortionMeasure{0, 0}.density(0, j).value == doctest::Approx(3));
  const double c = 5 / 3.0;
  CHECK(DistortionMeasure{0, 0.5}.density(0, j).value == doctest::Approx(c + std::sqrt(c * c - 1 + 0.5)));
  for (const DistortionMeasure measure : {DistortionMeasure{1}, {0}, {0.3}, {0, 0.25}}) {
    CHECK(measure.density(0, with_parts(1, 0)).value == doctest::Approx(measure.infimum()));
    CHECK(measure.density(std::numeric_limits<double>::infinity(), j).value == doctest::Approx(10));
  }
}

TEST_CASE("the derivatives are those of finite differences") {
  const double p = 2;
  const double q = 0.7;
  constexpr double h = 1e-6;
  for (const DistortionMeasure measure : {DistortionMeasure{1}, {0}, {0.3}, {0, 0.25}}) {
    for (const double regularization : {0.0, 0.3}) {
      // The quasi-conformal distortion is not regularized.
      if (measure.is_quasi_conformal() && regularization > 0) continue;
      const auto value = [&](double a, double b) { return measure.density(regularization, with_parts(a, b)).value; };
      const auto at = measure.density(regularization, with_parts(p, q));
      CHECK((value(p + h, q) - value(p - h, q)) / (2 * h) ==
            doctest::Approx(2 * p * (at.by_square + at.by_determinant)).epsilon(1e-6));
      CHECK((value(p, q + h) - value(p, q - h)) / (2 * h) ==
            doctest::Approx(2 * q * (at.by_square - at.by_determinant)).epsilon(1e-6));
    }
  }
}

TEST_CASE("the stiffness of the conformal distortion is its second derivative, for |f_z| and |f_zbar| apart") {
  const auto distortion = [](double a, double b) { return 2 * (a * a + b * b) / (a * a - b * b); };
  for (const double b : {0.0, 0.3, 0.9}) {
    MapJacobian j{};
    j.holomorphic = 1.5;
    j.antiholomorphic = 1.5 * b;
    j.half_square = std::norm(j.holomorphic) + std::norm(j.antiholomorphic);
    j.determinant = std::norm(j.holomorphic) - std::norm(j.antiholomorphic);
    const DistortionStiffness form = DistortionMeasure::conformal.stiffness(0, j);
    constexpr double h = 1e-4;
    const double p = 1.5;
    const double q = 1.5 * b;
    const double center = 2 * distortion(p, q);
    CHECK(form.antiholomorphic ==
          doctest::Approx((distortion(p, q + h) + distortion(p, q - h) - center) / (h * h)).epsilon(1e-3));
    const double along = (distortion(p + h, q) + distortion(p - h, q) - center) / (h * h);
    CHECK(form.holomorphic == doctest::Approx(along + 1e-3 * form.antiholomorphic).epsilon(1e-3));
    CHECK(form.holomorphic > 0);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
