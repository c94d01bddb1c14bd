#include <doctest/doctest.h>

#include "meshes.h"
#include "relaxation/equation_projection.h"
#include "relaxation/lbfgs.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("equation_projection");

TEST_CASE("the nearest solution, whatever the backend") {
  // u_0 = -u_1, v_0 = v_1, u_2 = 2 u_3; vertex 4 is held, somewhere, and vertex 5 is free.
  LinearEquations equations;
  equations.add({{0, 1}, {2, 1}});
  equations.add({{1, 1}, {3, -1}});
  equations.add({{4, 1}, {6, -2}});
  ComplexVector given(6);
  given << Complex(1, 7), Complex(4, -2), Complex(9, 6), Complex(-2, 1), Complex(3, 3), Complex(0.5, 8);
  for (const auto backend : backends()) {
    ComplexVector z = given;
    EquationProjection::of(equations, 6, backend).apply(z);
    ComplexVector nearest = given;
    nearest[0] = Complex(-1.5, 2.5);
    nearest[1] = Complex(1.5, 2.5);
    nearest[2] = Complex(6.4, 6);
    nearest[3] = Complex(3.2, 1);
    CHECK((z - nearest).norm() < 1e-13);
    CHECK(std::abs(real_dot(given - z, z)) < 1e-12);
  }
}

TEST_CASE("what is held stays, and moves no mirror axis away from its pair") {
  LinearEquations equations;
  equations.add({{0, 1}, {2, 1}});
  equations.held = {{0, 5.0}, {1, 5.0}, {2, -7.0}, {3, 5.0}};
  ComplexVector z = ComplexVector::Constant(2, Complex(3, 4));
  EquationProjection::of(equations, 2, FactorizationBackend::automatic).apply(z);
  CHECK(z.norm() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
