#include <doctest/doctest.h>

#include "spectral_conformal/linear_constraints.h"

namespace spectral_conformal::test {

TEST_SUITE("linear_constraints") {
  // u_0 = -u_1 about a mirror axis, on which vertex 2 lies; v_0 = v_1.
  const LinearConstraints mirrored{{0, 1, 0, 1, -1, 2}, {1, 1, -1, 1, 1, 1}, 3};

  TEST_CASE("P and its transpose") {
    const Eigen::Vector3d w(2, 3, 5);
    const ComplexVector z = mirrored.expanded(w);
    CHECK(z[0] == Complex(2, 3));
    CHECK(z[1] == Complex(-2, 3));
    CHECK(z[2] == Complex(0, 5));
    // w^T P^T x = (P w)^T x
    ComplexVector x(3);
    x << Complex(1, 7), Complex(4, -2), Complex(9, 6);
    CHECK(w.dot(mirrored.gathered(x)) == doctest::Approx(z.real().dot(x.real()) + z.imag().dot(x.imag())));
  }

  TEST_CASE("a mirror axis allows no translation across it") {
    CHECK(mirrored.translation(0).size() == 0);
    CHECK(mirrored.translation(1) == Eigen::Vector3d(0, 1, 1));
    CHECK(LinearConstraints{{0, 1, 0, 2}, {1, 1, 1, 1}, 3}.translation(0) == Eigen::Vector3d(1, 0, 0));
    CHECK(LinearConstraints{{0, 1, 0, 2}, {1, 1, -1, 1}, 3}.translation(0).size() == 0);
  }

  TEST_CASE("part of the vertices, and others without constraints") {
    const LinearConstraints part = mirrored.restricted({2, 1}, 1);
    CHECK(part.unknown == std::vector<int>{-1, 0, 1, 2, 3, 4});
    CHECK(part.sign == std::vector<signed char>{1, 1, -1, 1, 1, 1});
    CHECK(part.n_unknowns == 5);
  }
}

}  // namespace spectral_conformal::test
