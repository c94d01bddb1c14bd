#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

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

TEST_CASE("large matrices are dissected where their rows lie in space, unless it does not pay") {
  if (!has_cholmod()) return;
  for (const Mesh& mesh : {bumpy_grid(330, 330), quad_grid(460, 460)}) {
    const Patch patch(mesh);
    HermitianMatrix matrix = patch.energy(Weights::uniform).matrix();
    for (int v = 0; v < matrix.rows(); ++v) matrix.valuePtr()[matrix.outerIndexPtr()[v]] += 0.1;
    const ComplexVector expected = random_map(matrix.rows());
    const ComplexVector b = matrix.selfadjointView<Eigen::Lower>() * expected;
    // As of a surface that is crumpled: every plane cuts most of its edges.
    Positions crumpled = Positions::Zero(matrix.rows(), 3);
    crumpled.col(0) = random_map(matrix.rows()).real();
    crumpled.col(1) = random_map(matrix.rows()).imag();
    std::vector<double> nonzeros;
    const Positions* const given[] = {nullptr, &patch.positions, &crumpled};
    for (const Positions* const positions : given) {
      const auto factorization = make_cholmod_factorization();
      factorization->analyze(matrix, positions);
      nonzeros.push_back(factorization->factor_nonzeros());
      // The other two orders are that of smaller matrices, and take minutes under the sanitizers.
      if (positions != &patch.positions) continue;
      REQUIRE(factorization->factorize(matrix));
      ComplexVector x;
      factorization->solve(b, x);
      CHECK(difference(x, expected) < 1e-12);
    }
    // With quads, whose order AMD may find by luck, it saves multiplications, not memory.
    CHECK(nonzeros[1] < (mesh.offsets[1] == 3 ? 0.98 : 1.1) * nonzeros[0]);
    CHECK(nonzeros[1] != nonzeros[0]);
    CHECK(nonzeros[2] == nonzeros[0]);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
