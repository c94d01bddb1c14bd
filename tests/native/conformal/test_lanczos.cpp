#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "conformal/lanczos.h"

namespace spectral_conformal::test {
namespace {

/// diag(1, 2, ..., n), reflected so that its eigenvectors are no unit vectors.
class ReflectedDiagonal {
 public:
  using Scalar = double;
  using Vector = Eigen::VectorXd;
  explicit ReflectedDiagonal(int n, int max_calls = 1000) : n_(n), calls_left_(max_calls) {}
  Eigen::Index size() const { return n_; }
  Eigen::Index rows() const { return n_; }
  Eigen::Index cols() const { return n_; }
  bool interrupted() const { return interruption_.happened(); }
  Vector reflected(const Vector& x) const { return x.array() - 2 * x.mean(); }
  void perform_op(const double* x, double* y) const {
    interruption_.guard([&] {
      if (--calls_left_ < 0) throw std::runtime_error("no more calls");
      const Vector in = reflected(Eigen::Map<const Vector>(x, n_));
      Eigen::Map<Vector>(y, n_) = reflected(in.cwiseProduct(Vector::LinSpaced(n_, 1, n_)));
    });
  }

 private:
  int n_;
  mutable int calls_left_;
  mutable Interruption interruption_;
};

}  // namespace

TEST_SUITE("lanczos") {
  TEST_CASE("small problems densely, others iteratively: the eigenvector of the largest eigenvalue") {
    for (const int n : {1, 7, max_dimension, max_dimension + 1, 90}) {
      ReflectedDiagonal op(n);
      const Eigen::VectorXd start = Eigen::VectorXd::LinSpaced(n, 1, 3);
      const std::optional<Eigen::VectorXd> found = largest_eigenvector(op, start, {});
      REQUIRE(found);
      const Eigen::VectorXd expected = op.reflected(Eigen::VectorXd::Unit(n, n - 1));
      CHECK(std::abs(found->dot(expected)) == doctest::Approx(1).epsilon(1e-9));
    }
  }

  TEST_CASE("an exception of the operator passes through, and no convergence is none") {
    const Eigen::VectorXd start = Eigen::VectorXd::LinSpaced(90, 1, 3);
    ReflectedDiagonal interrupted(90, 3);
    CHECK_THROWS_AS(largest_eigenvector(interrupted, start, {}), std::runtime_error);
    ReflectedDiagonal op(90);
    EigenproblemOptions options;
    options.max_restarts = 1;
    CHECK_FALSE(largest_eigenvector(op, start, options));
  }
}

}  // namespace spectral_conformal::test
