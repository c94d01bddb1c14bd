#include <doctest/doctest.h>

#include <cmath>

#include "relaxation/line_search.h"

namespace spectral_conformal::test {
namespace {

/// |z|^4 of one vertex.
struct Quartic {
  int calls = 0;
  double operator()(const ComplexVector& z, ComplexVector& gradient) {
    ++calls;
    gradient = 4 * std::norm(z[0]) * z;
    return std::norm(z[0]) * std::norm(z[0]);
  }
};

DescendingMap at(Quartic& quartic, Complex z) {
  DescendingMap map;
  map.z = ComplexVector::Constant(1, z);
  map.energy = quartic(map.z, map.gradient);
  return map;
}

}  // namespace

TEST_SUITE_BEGIN("line_search");

TEST_CASE("the first length that lowers the energy enough is taken, and told to L-BFGS") {
  Quartic quartic;
  Lbfgs lbfgs;
  DescendingMap map = at(quartic, 2);
  const ComplexVector direction = ComplexVector::Constant(1, -16.0);
  // To -14, -6, -2 and 0.
  CHECK(move_down(quartic, direction, -32.0 * 16, 1, map, &lbfgs) == 0.125);
  CHECK(map.z[0] == 0.0);
  CHECK(map.energy == 0);
  CHECK(map.gradient[0] == 0.0);
  CHECK(quartic.calls == 1 + 4);
  const auto copy = [](const ComplexVector& b, ComplexVector& x) { x = b; };
  const ComplexVector gradient = ComplexVector::Constant(1, 32.0);
  // The secant through 0 and 2.
  CHECK(lbfgs.descent(copy, gradient)[0].real() == doctest::Approx(-2));
}

TEST_CASE("where no visible step lowers it, the map stays") {
  Quartic quartic;
  Lbfgs lbfgs;
  DescendingMap map = at(quartic, 0);
  CHECK(move_down(quartic, ComplexVector::Ones(1), -1.0, 1, map, &lbfgs) == 0);
  CHECK(map.z[0] == 0.0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
