#include <doctest/doctest.h>

#include <Eigen/QR>

#include "conformal/pin_attraction.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

const Pins pins{{1, {0, 0}}, {4, {3, 0.5}}, {5, {1, -2}}, {9, {-1, 1}}};

BoundaryForm form() {
  const Patch patch(bumpy_grid(5, 4));
  return boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
}

}  // namespace

TEST_SUITE_BEGIN("pin_attraction");

TEST_CASE("the form vanishes exactly where the pins are met up to a similarity") {
  const PinAttraction attraction = pin_attraction(pins, form(), 10);
  ComplexVector z = random_map(30);
  for (const auto& [vertex, position] : pins) z[vertex] = Complex(0.3, -2) * position + Complex(7, 8);
  CHECK(std::abs(attraction.value(z)) < 1e-24 * attraction.weight);
  z[4] += 0.1;
  CHECK(attraction.value(z) > 1e-4 * attraction.weight);
}

TEST_CASE("the form is the least squares distance to the similar images") {
  const PinAttraction attraction = pin_attraction(pins, form(), 2);
  const ComplexVector z = random_map(30);
  Eigen::MatrixXcd basis(4, 2);
  ComplexVector pinned(4);
  Eigen::Index row = 0;
  for (const auto& [vertex, position] : pins) {
    basis.row(row) << 1.0, position;
    pinned[row++] = z[vertex];
  }
  const ComplexVector rest = pinned - basis * basis.colPivHouseholderQr().solve(pinned);
  CHECK(attraction.value(z) == doctest::Approx(attraction.weight * rest.squaredNorm()));
  CHECK(attraction.weight == doctest::Approx(2 * form().total() / 4));
  ComplexVector applied = ComplexVector::Zero(30);
  attraction.subtract(z, applied);
  CHECK(-z.dot(applied).real() == doctest::Approx(attraction.value(z)));
}

TEST_CASE("without turns the form vanishes only for images that are scaled and moved") {
  const PinAttraction attraction = pin_attraction({{1, {0, 0}}, {4, {3, 0.5}}}, form(), 10, false);
  ComplexVector z = random_map(30);
  z[1] = Complex(7, 8);
  z[4] = -2.0 * Complex(3, 0.5) + Complex(7, 8);
  CHECK(attraction.value(z) < 1e-24 * attraction.weight);
  z[4] = Complex(0, -2) * Complex(3, 0.5) + Complex(7, 8);
  CHECK(attraction.value(z) > attraction.weight);
  ComplexVector fitted = z;
  REQUIRE(fit_to_pins(fitted, {{1, z[1]}, {4, z[1] + Complex(-4, 4) * (z[4] - z[1])}}, false));
  CHECK(difference(fitted - ComplexVector::Constant(30, fitted[0]), -4.0 * (z - ComplexVector::Constant(30, z[0]))) <
        1e-13);
}

TEST_CASE("a map is fitted to its pins") {
  const ComplexVector z = random_map(30);
  Pins images;
  for (const auto& [vertex, position] : pins) images[vertex] = Complex(-2, 1) * z[vertex] + Complex(5, 0);
  ComplexVector fitted = z;
  REQUIRE(fit_to_pins(fitted, images));
  CHECK(difference(fitted, (Complex(-2, 1) * z).array() + Complex(5, 0)) < 1e-14);
  fitted = z;
  REQUIRE(fit_to_pins(fitted, {{3, {1, 1}}}));
  CHECK(difference(fitted, z.array() + (Complex(1, 1) - z[3])) < 1e-14);
  fitted = z;
  CHECK_FALSE(fit_to_pins(fitted, {{3, {1, 1}}, {4, {1, 1}}}));
  CHECK(fitted == z);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
