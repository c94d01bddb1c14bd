#include <doctest/doctest.h>

#include <stdexcept>

#include "linear_algebra/blas_threads.h"
#include "linear_algebra/cholmod_factorization.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("cholmod_factorization");

TEST_CASE("with CHOLMOD a BLAS serves it; without, asking for it is an error") {
  if (has_cholmod()) {
    CHECK(make_cholmod_factorization() != nullptr);
    CHECK(cholmod_version_name().find('.') != std::string::npos);
    CHECK(blas_library().find("blas") != std::string::npos);
  } else {
    CHECK_THROWS_AS(make_cholmod_factorization(), std::invalid_argument);
    CHECK(cholmod_version_name().empty());
    CHECK(blas_library().empty());
  }
}

TEST_CASE("the ordering of large matrices solves too") {
  if (!has_cholmod()) return;
  constexpr int n = 600001;  // from 600,000 on CHOLMOD compares AMD with METIS
  HermitianMatrix matrix(n, n);
  matrix.reserve(Eigen::VectorXi::Constant(n, 2));
  for (int v = 0; v < n; ++v) {
    matrix.insert(v, v) = 2.1;
    if (v + 1 < n) matrix.insert(v + 1, v) = Complex(0.6, 0.8);
  }
  matrix.makeCompressed();
  const ComplexVector expected = random_map(n);
  const auto factorization = make_cholmod_factorization();
  factorization->analyze(matrix);
  REQUIRE(factorization->factorize(matrix));
  ComplexVector x = matrix.selfadjointView<Eigen::Lower>() * expected;
  factorization->solve(x, x);
  CHECK(difference(x, expected) < 1e-12);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
