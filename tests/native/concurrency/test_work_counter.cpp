#include <doctest/doctest.h>

#include "concurrency/helper_threads.h"
#include "concurrency/work_counter.h"
#include "linear_algebra/factorization.h"
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

WorkCounts counts_of(FactorizationBackend backend, Complex off_diagonal, int factorizations, int solves) {
  const WorkCounter counter;
  const HermitianMatrix matrix = full_matrix(5, off_diagonal);
  const auto factor = make_factorization(backend, matrix.rows());
  factor->analyze(matrix);
  for (int i = 0; i < factorizations; ++i) REQUIRE(factor->factorize(matrix));
  const ComplexVector b = ComplexVector::Ones(matrix.rows());
  ComplexVector x;
  for (int i = 0; i < solves; ++i) factor->solve(b, x);
  return counter.counts();
}

}  // namespace

TEST_SUITE("work_counter") {
  TEST_CASE("threads count for the counter of the thread they work for, and no other") {
    count_analysis();
    const WorkCounter outer;
    {
      const WorkCounter inner;
      {
        const HelperThreads helpers(3, [] { count_factorization(2); });
      }
      count_analysis();
      CHECK(inner.counts().analyses == 1);
      CHECK(inner.counts().multiplications == 2 * inner.counts().factorizations);
    }
    count_solve(5);
    CHECK(outer.counts().analyses == 0);
    CHECK(outer.counts().factorizations == 0);
    CHECK(outer.counts().solves == 1);
    CHECK(outer.counts().solve_doubles == 5);
  }

  TEST_CASE("analyzes, factorizations and solves are counted with both libraries") {
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
