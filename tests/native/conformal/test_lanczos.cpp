#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

#include "conformal/lanczos.h"

namespace spectral_conformal::test {
namespace {

/// diag(1, 2, ..., n), reflected so that its eigenvectors are no unit vectors.
class ReflectedDiagonal {
 public:
  using Scalar = double;
  explicit ReflectedDiagonal(int n, int max_calls = 1000) : n_(n), calls_left_(max_calls) {}
  Eigen::Index rows() const { return n_; }
  Eigen::Index cols() const { return n_; }
  bool interrupted() const { return interruption_.happened(); }
  Eigen::VectorXd reflected(const Eigen::VectorXd& x) const { return x.array() - 2 * x.mean(); }
  void perform_op(const double* x, double* y) const {
    interruption_.guard([&] {
      if (--calls_left_ < 0) throw std::runtime_error("no more calls");
      const Eigen::VectorXd in = reflected(Eigen::Map<const Eigen::VectorXd>(x, n_));
      Eigen::Map<Eigen::VectorXd>(y, n_) = reflected(in.cwiseProduct(Eigen::VectorXd::LinSpaced(n_, 1, n_)));
    });
  }

 private:
  int n_;
  mutable int calls_left_;
  mutable Interruption interruption_;
};

}  // namespace

TEST_SUITE("lanczos") {
  TEST_CASE("the eigenvector of the largest eigenvalue; no convergence is none; an exception passes through") {
    const int n = 90;
    const Eigen::VectorXd start = Eigen::VectorXd::LinSpaced(n, 1, 3);
    EigenproblemOptions options;
    const auto converges_with = [&](ReflectedDiagonal& op) {
      Spectra::SymEigsSolver<ReflectedDiagonal> solver(op, 1, options.krylov_dimension);
      solver.init(start.data());
      if (!converges(solver, op, options)) return false;
      const Eigen::VectorXd expected = op.reflected(Eigen::VectorXd::Unit(n, n - 1));
      CHECK(std::abs(solver.eigenvectors(1).col(0).dot(expected)) == doctest::Approx(1).epsilon(1e-9));
      return true;
    };
    ReflectedDiagonal op(n);
    CHECK(converges_with(op));
    ReflectedDiagonal interrupted(n, 9);
    CHECK_THROWS_AS(converges_with(interrupted), std::runtime_error);
    options.max_restarts = 1;
    CHECK_FALSE(converges_with(op));
  }
}

}  // namespace spectral_conformal::test
