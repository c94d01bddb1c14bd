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

namespace {

/// The energy of a patch, with masses that make it positive definite.
HermitianMatrix positive_definite_energy(const Patch& patch) {
  HermitianMatrix matrix = patch.energy(Weights::uniform).matrix();
  for (int v = 0; v < matrix.rows(); ++v) matrix.valuePtr()[matrix.outerIndexPtr()[v]] += 0.1;
  return matrix;
}

/// What the factor holds, in the order for these positions.
double nonzeros_of_factor(const HermitianMatrix& matrix, const Positions* positions) {
  const auto factorization = make_cholmod_factorization();
  factorization->analyze(matrix, positions);
  return factorization->factor_nonzeros();
}

}  // namespace

TEST_CASE("large matrices are dissected where their rows lie in space (large)") {
  if (!has_cholmod()) return;
  for (const Mesh& mesh : {bumpy_grid(330, 330), quad_grid(460, 460)}) {
    const Patch patch(mesh);
    const HermitianMatrix matrix = positive_definite_energy(patch);
    const ComplexVector expected = random_map(matrix.rows());
    const auto factorization = make_cholmod_factorization();
    factorization->analyze(matrix, &patch.positions);
    const double without = nonzeros_of_factor(matrix, nullptr);
    // With quads, whose order AMD may find by luck, it saves multiplications, not memory.
    CHECK(factorization->factor_nonzeros() < (mesh.offsets[1] == 3 ? 0.98 : 1.1) * without);
    CHECK(factorization->factor_nonzeros() != without);
    REQUIRE(factorization->factorize(matrix));
    ComplexVector x;
    factorization->solve(matrix.selfadjointView<Eigen::Lower>() * expected, x);
    CHECK(difference(x, expected) < 1e-12);
  }
}

TEST_CASE("large matrices are not dissected where it does not pay (large)") {
  if (!has_cholmod()) return;
  // The smaller one of those above: its separators are so large that they take minutes under the sanitizers.
  const HermitianMatrix matrix = positive_definite_energy(Patch(bumpy_grid(330, 330)));
  // As of a surface that is crumpled: every plane cuts most of its edges.
  Positions crumpled = Positions::Zero(matrix.rows(), 3);
  crumpled.col(0) = random_map(matrix.rows()).real();
  crumpled.col(1) = random_map(matrix.rows()).imag();
  CHECK(nonzeros_of_factor(matrix, &crumpled) == nonzeros_of_factor(matrix, nullptr));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
