#include <doctest/doctest.h>

#include "linear_algebra/factorization.h"
#include "linear_algebra/work_counts.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// n equations, each with each.
HermitianMatrix full_matrix(int n, Complex off_diagonal) {
  Eigen::MatrixXcd dense = Eigen::MatrixXcd::Constant(n, n, Complex(0));
  for (int j = 0; j < n; ++j) {
    dense(j, j) = 2.0 * n;
    for (int i = j + 1; i < n; ++i) dense(i, j) = off_diagonal;
  }
  return dense.sparseView();
}

/// What happened between two looks.
WorkCounts operator-(const WorkCounts& a, const WorkCounts& b) {
  return {a.analyses - b.analyses, a.factorizations - b.factorizations, a.solves - b.solves,
          a.multiplications - b.multiplications, a.solve_doubles - b.solve_doubles};
}

WorkCounts counts_of(FactorizationBackend backend, Complex off_diagonal, int factorizations, int solves) {
  const WorkCounts before = work_counts();
  const HermitianMatrix matrix = full_matrix(5, off_diagonal);
  const auto factor = make_factorization(backend, matrix.rows());
  factor->analyze(matrix);
  for (int i = 0; i < factorizations; ++i) REQUIRE(factor->factorize(matrix));
  const ComplexVector b = ComplexVector::Ones(matrix.rows());
  ComplexVector x;
  for (int i = 0; i < solves; ++i) factor->solve(b, x);
  return work_counts() - before;
}

}  // namespace

TEST_SUITE("work_counts") {
  TEST_CASE("analyses, factorisations and solves are counted with both libraries") {
    for (const auto backend : backends()) {
      const WorkCounts counts = counts_of(backend, Complex(1), 2, 3);
      CHECK(counts.analyses == 1);
      CHECK(counts.factorizations == 2);
      CHECK(counts.solves >= 3);
    }
  }

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
  TEST_CASE("a complex factor costs four times a real one, and twice in a solve") {
    const WorkCounts real = counts_of(FactorizationBackend::cholmod, Complex(1), 1, 1);
    const WorkCounts complex = counts_of(FactorizationBackend::cholmod, Complex(1, 0.5), 1, 1);
    // Columns of 5, 4, 3, 2 and 1 rows: 15 + 10 + 6 + 3 + 1.
    CHECK(real.multiplications == 35);
    CHECK(complex.multiplications == 4 * real.multiplications);
    // Down and up again, through a block of 5 x 5.
    CHECK(real.solve_doubles == 50);
    CHECK(complex.solve_doubles == 2 * real.solve_doubles);
  }
#endif
}

}  // namespace spectral_conformal::test
