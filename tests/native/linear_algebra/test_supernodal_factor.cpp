#include <doctest/doctest.h>

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "linear_algebra/supernodal_factor.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

ComplexVector in_order(const ComplexVector& b, const std::vector<int>& order) {
  ComplexVector result(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) result[i] = b[order[i]];
  return result;
}

ComplexVector solve(SupernodalFactor& factor, const ComplexVector& b) {
  ComplexVector work = in_order(b, factor.symbolic().order());
  const SymbolicFactor::Path all = factor.symbolic().whole();
  factor.forward(all, work);
  factor.backward(all, work);
  ComplexVector x(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) x[factor.symbolic().order()[i]] = work[i];
  return x;
}

/// With uniform weights only the edges of the boundary have an imaginary part.
HermitianMatrix mixed_energy(int size) {
  HermitianMatrix matrix = Patch(bumpy_grid(size, size)).energy(Weights::uniform).matrix();
  for (int v = 0; v < matrix.cols(); ++v) matrix.coeffRef(v, v) += 0.01;
  return matrix;
}

HermitianMatrix without_imaginary_part(const HermitianMatrix& matrix) {
  HermitianMatrix result = matrix;
  for (int e = 0; e < result.nonZeros(); ++e) result.valuePtr()[e] = result.valuePtr()[e].real();
  return result;
}

/// As inverse-area weights make it.
HermitianMatrix with_imaginary_part_everywhere(const HermitianMatrix& matrix) {
  HermitianMatrix result = matrix;
  for (int column = 0; column < result.cols(); ++column) {
    for (HermitianMatrix::InnerIterator it(result, column); it; ++it) {
      if (it.row() != column) it.valueRef() += Complex(0, 1e-3 * (1 + column % 3));
    }
  }
  for (int v = 0; v < result.cols(); ++v) result.coeffRef(v, v) += 0.1;
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("supernodal_factor");

TEST_CASE("real, complex and mixed blocks solve as a dense factorization does") {
  constexpr int size = 18;
  const HermitianMatrix mixed = mixed_energy(size);
  const int n = static_cast<int>(mixed.cols());
  for (const HermitianMatrix& matrix : {mixed, without_imaginary_part(mixed), with_imaginary_part_everywhere(mixed)}) {
    std::vector<int> reversed(n);
    std::iota(reversed.rbegin(), reversed.rend(), 0);
    for (const std::vector<int>& order : {strips_first(n), reversed}) {
      SupernodalFactor factor;
      factor.analyze(matrix, graph_of(matrix), structure_of(matrix, order));
      REQUIRE(factor.factorize(matrix));
      const ComplexVector b = random_map(n);
      const ComplexVector expected = Eigen::LLT<Eigen::MatrixXcd>(dense(matrix)).solve(b);
      CHECK(difference(solve(factor, b), expected) < 1e-12);
    }
  }
}

TEST_CASE("not a bit depends on the number of threads") {
  constexpr int size = 40;
  const HermitianMatrix matrix = mixed_energy(size);
  const int n = static_cast<int>(matrix.cols());
  const SupernodalStructure structure = structure_of(matrix, strips_first(n));
  const ComplexVector b = random_map(n);
  ComplexVector alone;
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    SupernodalFactor factor(threads);
    factor.analyze(matrix, graph_of(matrix), structure);
    for (int repeat = 0; repeat < 5; ++repeat) {
      REQUIRE(factor.factorize(matrix));
      const ComplexVector x = solve(factor, b);
      if (alone.size() == 0) alone = x;
      CHECK(x == alone);
    }
  }
}

TEST_CASE("a solve along a path agrees there with the whole") {
  constexpr int size = 25;
  const HermitianMatrix matrix = mixed_energy(size);
  const int n = static_cast<int>(matrix.cols());
  SupernodalFactor factor(2);
  factor.analyze(matrix, graph_of(matrix), structure_of(matrix, strips_first(n)));
  REQUIRE(factor.factorize(matrix));
  const std::vector<int> columns{3, n / 2, n - 1};
  const SymbolicFactor::Path path = factor.symbolic().above(columns);
  ComplexVector b = ComplexVector::Zero(n);
  for (const int column : columns) b[column] = Complex(1, column);
  ComplexVector along = b;
  factor.forward(path, along);
  factor.backward(path, along);
  ComplexVector whole = b;
  factor.forward(factor.symbolic().whole(), whole);
  factor.backward(factor.symbolic().whole(), whole);
  for (const int column : columns) CHECK(std::abs(along[column] - whole[column]) < 1e-13 * whole.norm());
}

TEST_CASE("an indefinite matrix is refused by any number of threads, and the next one factorized") {
  constexpr int size = 30;
  const HermitianMatrix good = mixed_energy(size);
  const int n = static_cast<int>(good.cols());
  for (const int negative : {0, n / 2, n - 1}) {
    HermitianMatrix indefinite = good;
    indefinite.coeffRef(negative, negative) = -1;
    for (const unsigned threads : {1U, 4U}) {
      SupernodalFactor factor(threads);
      factor.analyze(good, graph_of(good), structure_of(good, strips_first(n)));
      CHECK_FALSE(factor.factorize(indefinite));
      REQUIRE(factor.factorize(good));
      const ComplexVector expected = random_map(n);
      const ComplexVector b = good.selfadjointView<Eigen::Lower>() * expected;
      CHECK(difference(solve(factor, b), expected) < 1e-12);
    }
  }
}

TEST_CASE("real blocks take half the memory") {
  constexpr int size = 30;
  const HermitianMatrix mixed = mixed_energy(size);
  const int n = static_cast<int>(mixed.cols());
  // The boundary last.
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&mixed](int v) {
    const int first = mixed.outerIndexPtr()[v];
    const int last = mixed.outerIndexPtr()[v + 1];
    return std::all_of(mixed.valuePtr() + first, mixed.valuePtr() + last, [](Complex a) { return a.imag() == 0; });
  });
  const auto doubles = [&](const HermitianMatrix& matrix) {
    SupernodalFactor factor;
    factor.analyze(matrix, graph_of(matrix), structure_of(matrix, order));
    REQUIRE(factor.factorize(matrix));
    return factor.n_doubles() / factor.symbolic().nonzeros();
  };
  CHECK(doubles(without_imaginary_part(mixed)) == 1);
  CHECK(doubles(with_imaginary_part_everywhere(mixed)) == 2);
  CHECK(doubles(mixed) > 1);
  CHECK(doubles(mixed) < 2);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test

#else

#include "linear_algebra/cholmod_factorization.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("supernodal_factor");

TEST_CASE("without CHOLMOD there is no BLAS for it") { CHECK_FALSE(has_cholmod()); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test

#endif
