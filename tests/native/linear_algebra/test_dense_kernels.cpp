#include <doctest/doctest.h>

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <Eigen/Cholesky>
#include <type_traits>

#include "linear_algebra/dense_kernels.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

template <class Scalar>
Matrix<Scalar> random_matrix(int rows, int columns) {
  const ComplexVector numbers = random_map(static_cast<Eigen::Index>(rows) * columns, 3);
  const Eigen::MatrixXcd complex = Eigen::Map<const Eigen::MatrixXcd>(numbers.data(), rows, columns);
  if constexpr (std::is_same_v<Scalar, double>) {
    return complex.real();
  } else {
    return complex;
  }
}

/// A Hermitian positive definite matrix of which the first columns are eliminated.
template <class Scalar>
void check_elimination_and_solves(int width, int height) {
  const Matrix<Scalar> root = random_matrix<Scalar>(height, height);
  const Matrix<Scalar> whole = root * root.adjoint() + height * Matrix<Scalar>::Identity(height, height);
  Matrix<Scalar> columns = whole.leftCols(width);
  const DenseBlock<Scalar> block{width, height, columns.data()};
  REQUIRE(eliminate_columns(block));
  if (block.below() > 0) divide_below(block);
  const Matrix<Scalar> l = columns.topRows(width).template triangularView<Eigen::Lower>();
  const Matrix<Scalar> b = columns.bottomRows(height - width);
  CHECK((l * l.adjoint() - whole.topLeftCorner(width, width)).norm() < 1e-13 * whole.norm());
  CHECK((b * l.adjoint() - whole.bottomLeftCorner(height - width, width)).norm() < 1e-13 * whole.norm());
  Matrix<Scalar> c = Matrix<Scalar>::Zero(height - width, height - width);
  if (block.below() > 0) multiply_below(block, c.data());
  const Matrix<Scalar> product = b * b.adjoint();
  CHECK(((c + product).template triangularView<Eigen::Lower>().toDenseMatrix()).norm() <= 1e-13 * product.norm());

  const ComplexVector x = random_map(width, 5);
  const ComplexVector y = random_map(height - width, 6);
  ComplexVector own = x;
  ComplexVector passed = y;
  solve_lower(block, own.data(), passed.data());
  CHECK((l * own - x).norm() < 1e-12 * x.norm());
  CHECK((passed + b * own - y).norm() <= 1e-12 * (y.norm() + own.norm()));
  own = x;
  solve_upper(block, own.data(), y.data());
  CHECK((l.adjoint() * own + b.adjoint() * y - x).norm() < 1e-12 * (x.norm() + y.norm()));
}

}  // namespace

TEST_SUITE_BEGIN("dense_kernels");

TEST_CASE("small blocks and those of the BLAS") {
  for (const int width : {1, 3, 4, 9, 24, 25, 40}) {
    for (const int below : {0, 1, 5, 60}) {
      CAPTURE(width);
      CAPTURE(below);
      check_elimination_and_solves<double>(width, width + below);
      check_elimination_and_solves<Complex>(width, width + below);
    }
  }
}

TEST_CASE("an indefinite block is refused") {
  for (const int n : {2, 30}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n);
    a(n - 1, n - 1) = -1;
    Eigen::MatrixXcd complex = a.cast<Complex>();
    CHECK_FALSE(eliminate_columns(DenseBlock<double>{n, n, a.data()}));
    CHECK_FALSE(eliminate_columns(DenseBlock<Complex>{n, n, complex.data()}));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test

#else

#include "linear_algebra/cholmod_factorization.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("dense_kernels");

TEST_CASE("without CHOLMOD there is no BLAS for them") { CHECK_FALSE(has_cholmod()); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test

#endif
