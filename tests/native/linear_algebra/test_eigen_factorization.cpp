#include <doctest/doctest.h>

#include "linear_algebra/eigen_factorization.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("eigen_factorization");

TEST_CASE("an indefinite matrix that has an L D L^H is refused") {
  HermitianMatrix matrix(2, 2);
  matrix.insert(0, 0) = 1;
  matrix.insert(1, 0) = Complex(0, 2);
  matrix.insert(1, 1) = 1;  // D = diag(1, 1 - |2 i|^2)
  const auto factorization = make_eigen_factorization();
  factorization->analyze(matrix);
  CHECK_FALSE(factorization->factorize(matrix));
  matrix.coeffRef(1, 1) = 5;
  REQUIRE(factorization->factorize(matrix));
  CHECK(factorization->factor_nonzeros() == 1);  // below the unit diagonal of L
  ComplexVector x(2);
  x << Complex(1, 0), Complex(0, 2);  // the first column
  factorization->solve(x, x);
  CHECK(std::abs(x[0] - 1.0) < 1e-15);
  CHECK(std::abs(x[1]) < 1e-15);
}

TEST_CASE("the version is that of the headers") { CHECK(eigen_version().rfind("3.", 0) == 0); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test
