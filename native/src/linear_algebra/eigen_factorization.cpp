#include "linear_algebra/eigen_factorization.h"

#include <Eigen/SparseCholesky>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"

namespace spectral_conformal {
namespace {

/// Exposes the size of the factor, which Eigen counts in ints, before the factorization.
class SimplicialLdlt : public Eigen::SimplicialLDLT<HermitianMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> {
 public:
  double planned_nonzeros() const {
    double sum = 0;
    const auto* start = m_matrix.outerIndexPtr();
    // If the factor is too large, the column starts have wrapped around; their differences have not.
    for (Eigen::Index k = 0; k < m_matrix.outerSize(); ++k) {
      sum += static_cast<unsigned>(start[k + 1]) - static_cast<unsigned>(start[k]);
    }
    return sum;
  }
};

class EigenFactorization final : public Factorization {
 public:
  using Factorization::analyze;
  void analyze(const HermitianMatrix& matrix, const Positions* /*positions*/) override {
    count_analysis();
    call_while_polling(matrix.nonZeros(), [&] { ldlt_.analyzePattern(matrix); });
    planned_nonzeros_ = ldlt_.planned_nonzeros();
    check_factor_size(planned_nonzeros_);
  }

  std::vector<int> order(const Adjacency& /*graph*/, const Positions* /*positions*/) const override { return {}; }
  void analyze_in_order(const HermitianMatrix& matrix, const std::vector<char>& /*is_real*/) override {
    analyze(matrix, nullptr);
  }

  bool factorize(const HermitianMatrix& matrix) override {
    count_factorization(0);
    call_while_polling(planned_nonzeros_, [&] { ldlt_.factorize(matrix); });
    // L D L^H also exists for some indefinite matrices; positive definite means positive pivots.
    return ldlt_.info() == Eigen::Success && (ldlt_.vectorD().real().array() > 0).all();
  }

  void solve(const ComplexVector& b, ComplexVector& x) override {
    count_solve(0);
    call_while_polling(planned_nonzeros_, [&] { x = ldlt_.solve(b); });
  }

  void select(std::vector<int> vertices) override { selected_ = std::move(vertices); }

  void solve_selected(const ComplexVector& b, ComplexVector& x) override {
    solve_from_selected(b, solved_);
    x.resize(b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = solved_[selected_[i]];
  }

  void solve_from_selected(const ComplexVector& b, ComplexVector& x) override {
    scattered_.setZero(ldlt_.rows());
    for (Eigen::Index i = 0; i < b.size(); ++i) scattered_[selected_[i]] = b[i];
    solve(scattered_, x);
  }

  double factor_nonzeros() const override {
    const HermitianMatrix& factor = ldlt_.matrixL().nestedExpression();
    return static_cast<double>(factor.nonZeros());
  }

 private:
  SimplicialLdlt ldlt_;
  double planned_nonzeros_ = 0;
  std::vector<int> selected_;
  // Work space.
  ComplexVector scattered_;
  ComplexVector solved_;
};

}  // namespace

std::unique_ptr<Factorization> make_eigen_factorization() { return std::make_unique<EigenFactorization>(); }

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

}  // namespace spectral_conformal
