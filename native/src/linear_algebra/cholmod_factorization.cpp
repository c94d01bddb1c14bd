#include "linear_algebra/cholmod_factorization.h"

#include <stdexcept>

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <cholmod.h>

#include <limits>
#include <new>
#include <vector>

#include "linear_algebra/blas_threads.h"
#include "linear_algebra/supernodal_factor.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

class CholmodFactorization final : public Factorization {
 public:
  CholmodFactorization() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.postorder = 1;
  }
  ~CholmodFactorization() override { cholmod_finish(&common_); }
  CholmodFactorization(const CholmodFactorization&) = delete;
  CholmodFactorization& operator=(const CholmodFactorization&) = delete;

  void analyze(const HermitianMatrix& matrix) override {
    // Below, AMD alone is faster than AMD and METIS, of which CHOLMOD by itself takes the better: with 535,000 vertices
    // and CHOLMOD's own factorisation 8.2 against 8.3 s. Beyond, METIS saves memory (0.71 instead of 1.08 GB).
    constexpr Eigen::Index compare_from = 600000;
    common_.nmethods = matrix.rows() < compare_from ? 1 : 0;
    common_.method[0].ordering = CHOLMOD_AMD;
    cholmod_sparse view = view_of(matrix);
    cholmod_factor* symbolic = cholmod_analyze(&view, &common_);
    check();
    try {
      factor_.analyze(matrix, structure_of(*symbolic));
    } catch (...) {
      cholmod_free_factor(&symbolic, &common_);
      throw;
    }
    cholmod_free_factor(&symbolic, &common_);
    all_ = factor_.whole();
    work_.setZero(factor_.n());
  }

  bool factorize(const HermitianMatrix& matrix) override { return factor_.factorize(matrix); }

  void solve(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads;
    for (Eigen::Index i = 0; i < work_.size(); ++i) work_[i] = b[factor_.order()[i]];
    factor_.forward(all_, work_);
    factor_.backward(all_, work_);
    permute_back(x);
  }

  void select(std::vector<int> vertices) override {
    std::vector<int> index(static_cast<std::size_t>(factor_.n()));
    for (int i = 0; i < factor_.n(); ++i) index[factor_.order()[i]] = i;
    selected_.clear();
    for (const int vertex : vertices) selected_.push_back(index[vertex]);
    reached_ = factor_.above(selected_);
  }

  void solve_selected(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads;
    for (const int k : reached_.supernodes()) {
      work_.segment(factor_.first_column(k), factor_.first_column(k + 1) - factor_.first_column(k)).setZero();
    }
    for (Eigen::Index i = 0; i < b.size(); ++i) work_[selected_[i]] = b[i];
    factor_.forward(reached_, work_);
    factor_.backward(reached_, work_);
    x.resize(b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = work_[selected_[i]];
  }

  void solve_from_selected(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads;
    work_.setZero();
    for (Eigen::Index i = 0; i < b.size(); ++i) work_[selected_[i]] = b[i];
    factor_.forward(reached_, work_);
    factor_.backward(all_, work_);
    permute_back(x);
  }

  double factor_nonzeros() const override { return factor_.nonzeros(); }

 private:
  /// CHOLMOD's User Guide, section "The cholmod_factor object".
  static SupernodalStructure structure_of(const cholmod_factor& symbolic) {
    const auto* const order = static_cast<const int*>(symbolic.Perm);
    const auto* const first_column = static_cast<const int*>(symbolic.super);
    const auto* const first_row = static_cast<const int*>(symbolic.pi);
    const auto* const rows = static_cast<const int*>(symbolic.s);
    return {{order, order + symbolic.n},
            {first_column, first_column + symbolic.nsuper + 1},
            {first_row, first_row + symbolic.nsuper + 1},
            {rows, rows + first_row[symbolic.nsuper]}};
  }

  void permute_back(ComplexVector& x) const {
    x.resize(work_.size());
    for (Eigen::Index i = 0; i < work_.size(); ++i) x[factor_.order()[i]] = work_[i];
  }

  static cholmod_sparse view_of(const HermitianMatrix& matrix) {
    cholmod_sparse view{};
    view.nrow = static_cast<std::size_t>(matrix.rows());
    view.ncol = static_cast<std::size_t>(matrix.cols());
    view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
    view.p = const_cast<int*>(matrix.outerIndexPtr());
    view.i = const_cast<int*>(matrix.innerIndexPtr());
    view.x = const_cast<Complex*>(matrix.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_COMPLEX;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
  }

  void check() const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common_.status == CHOLMOD_TOO_LARGE) check_factor_size(std::numeric_limits<double>::infinity());
    if (common_.status < CHOLMOD_OK) {
      throw SolveFailure("CHOLMOD reported status " + std::to_string(common_.status),
                         "please report this with the mesh.");
    }
  }

  cholmod_common common_{};
  SupernodalFactor factor_;
  SupernodalFactor::Path all_;
  std::vector<int> selected_;       ///< columns
  SupernodalFactor::Path reached_;  ///< from the selected columns
  ComplexVector work_;              ///< in the factor's order
};

}  // namespace

bool has_cholmod() { return true; }

std::unique_ptr<Factorization> make_cholmod_factorization() { return std::make_unique<CholmodFactorization>(); }

std::string cholmod_version_name() {
  int version[3];
  cholmod_version(version);
  return std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]);
}

}  // namespace spectral_conformal

#else

namespace spectral_conformal {

bool has_cholmod() { return false; }

std::unique_ptr<Factorization> make_cholmod_factorization() {
  throw std::invalid_argument("This build has no CHOLMOD; install SuiteSparse and build again, or use 'eigen'.");
}

std::string cholmod_version_name() { return ""; }

}  // namespace spectral_conformal

#endif
