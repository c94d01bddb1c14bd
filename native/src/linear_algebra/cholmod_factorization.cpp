#include "linear_algebra/cholmod_factorization.h"

#include <stdexcept>

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "linear_algebra/blas_threads.h"
#include "spectral_conformal/errors.h"

// BLAS, Fortran linkage.
extern "C" {
void ztrsv_(const char*, const char*, const char*, const int*, const void*, const int*, void*, const int*);
void zgemv_(const char*, const int*, const int*, const void*, const void*, const int*, const void*, const int*,
            const void*, void*, const int*);
}

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
  ~CholmodFactorization() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  CholmodFactorization(const CholmodFactorization&) = delete;
  CholmodFactorization& operator=(const CholmodFactorization&) = delete;

  void analyze(const HermitianMatrix& matrix) override {
    cholmod_free_factor(&factor_, &common_);
    // Below, AMD alone is faster than AMD and METIS, of which CHOLMOD by itself takes the better: with 535,000 vertices
    // 8.2 against 8.3 s. Beyond, METIS saves more than it costs, and memory (0.71 instead of 1.08 GB).
    constexpr Eigen::Index compare_from = 600000;
    common_.nmethods = matrix.rows() < compare_from ? 1 : 0;
    common_.method[0].ordering = CHOLMOD_AMD;
    cholmod_sparse view = view_of(matrix);
    factor_ = cholmod_analyze(&view, &common_);
    check();
    supernode_of_.resize(factor_->n);
    all_.resize(factor_->nsuper);
    int max_rows = 0;
    for (int k = 0; k < static_cast<int>(factor_->nsuper); ++k) {
      all_[k] = k;
      max_rows = std::max(max_rows, rows(k));
      for (int column = first_column(k); column < first_column(k + 1); ++column) supernode_of_[column] = k;
    }
    work_.setZero(static_cast<Eigen::Index>(factor_->n));
    below_.resize(max_rows);
  }

  bool factorize(const HermitianMatrix& matrix) override {
    // A second thread gains a third on idle cores from here on; on smaller fronts it gains nothing, and stalls while
    // the other core is busy.
    constexpr std::size_t two_from = 40000;
    const BlasThreads threads(factor_->n < two_from ? BlasThreads::Count::one : BlasThreads::Count::two);
    cholmod_sparse view = view_of(matrix);
    cholmod_factorize(&view, factor_, &common_);
    if (common_.status == CHOLMOD_NOT_POSDEF) return false;
    check();
    return true;
  }

  void solve(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads(BlasThreads::Count::one);
    const int* order = permutation();
    for (std::size_t i = 0; i < factor_->n; ++i) work_[static_cast<Eigen::Index>(i)] = b[order[i]];
    forward(all_);
    backward(all_);
    permute_back(x);
  }

  void select(std::vector<int> vertices) override {
    std::vector<int> index(factor_->n);
    for (std::size_t i = 0; i < factor_->n; ++i) index[permutation()[i]] = static_cast<int>(i);
    selected_.clear();
    for (const int vertex : vertices) selected_.push_back(index[vertex]);
    // Everything above the selected vertices in the elimination tree of supernodes.
    std::vector<char> reached(factor_->nsuper, 0);
    for (const int column : selected_) {
      for (int k = supernode_of_[column]; k >= 0 && !reached[k]; k = parent(k)) reached[k] = 1;
    }
    reached_.clear();
    for (std::size_t k = 0; k < factor_->nsuper; ++k) {
      if (reached[k]) reached_.push_back(static_cast<int>(k));
    }
  }

  void solve_selected(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads(BlasThreads::Count::one);
    for (const int k : reached_) work_.segment(first_column(k), columns(k)).setZero();
    for (Eigen::Index i = 0; i < b.size(); ++i) work_[selected_[i]] = b[i];
    forward(reached_);
    backward(reached_);
    x.resize(b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = work_[selected_[i]];
  }

  void solve_from_selected(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads(BlasThreads::Count::one);
    work_.setZero();
    for (Eigen::Index i = 0; i < b.size(); ++i) work_[selected_[i]] = b[i];
    forward(reached_);
    backward(all_);
    permute_back(x);
  }

  double factor_nonzeros() const override { return static_cast<double>(factor_->xsize); }

 private:
  // Supernode k: a dense column-major block of rows(k) x columns(k), lower triangular at the top; the rows below it are
  // named by row_indices(k). CHOLMOD's User Guide, section "The cholmod_factor object".
  const int* permutation() const { return static_cast<const int*>(factor_->Perm); }
  int first_column(int k) const { return static_cast<const int*>(factor_->super)[k]; }
  int columns(int k) const { return first_column(k + 1) - first_column(k); }
  int rows(int k) const {
    const int* start = static_cast<const int*>(factor_->pi);
    return start[k + 1] - start[k];
  }
  const int* row_indices(int k) const {
    return static_cast<const int*>(factor_->s) + static_cast<const int*>(factor_->pi)[k];
  }
  const Complex* block(int k) const {
    return static_cast<const Complex*>(factor_->x) + static_cast<const int*>(factor_->px)[k];
  }
  int parent(int k) const { return rows(k) == columns(k) ? -1 : supernode_of_[row_indices(k)[columns(k)]]; }

  /// work <- L^-1 work over the given supernodes, ascending.
  void forward(const std::vector<int>& supernodes) {
    constexpr int one = 1;
    const Complex unit(1);
    const Complex zero(0);
    for (const int k : supernodes) {
      const int width = columns(k);
      const int height = rows(k);
      const int below = height - width;
      Complex* const own = work_.data() + first_column(k);
      ztrsv_("L", "N", "N", &width, block(k), &height, own, &one);
      if (below == 0) continue;
      zgemv_("N", &below, &width, &unit, block(k) + width, &height, own, &one, &zero, below_.data(), &one);
      const int* const target = row_indices(k) + width;
      for (int i = 0; i < below; ++i) work_[target[i]] -= below_[i];
    }
  }

  /// work <- L^-H work over the given supernodes, descending; closed under parents.
  void backward(const std::vector<int>& supernodes) {
    constexpr int one = 1;
    const Complex minus(-1);
    const Complex unit(1);
    for (auto k = supernodes.rbegin(); k != supernodes.rend(); ++k) {
      const int width = columns(*k);
      const int height = rows(*k);
      const int below = height - width;
      Complex* const own = work_.data() + first_column(*k);
      if (below > 0) {
        const int* const source = row_indices(*k) + width;
        for (int i = 0; i < below; ++i) below_[i] = work_[source[i]];
        zgemv_("C", &below, &width, &minus, block(*k) + width, &height, below_.data(), &one, &unit, own, &one);
      }
      ztrsv_("L", "C", "N", &width, block(*k), &height, own, &one);
    }
  }

  void permute_back(ComplexVector& x) const {
    x.resize(work_.size());
    for (Eigen::Index i = 0; i < work_.size(); ++i) x[permutation()[i]] = work_[i];
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
  cholmod_factor* factor_ = nullptr;
  std::vector<int> supernode_of_;  ///< of each column
  std::vector<int> all_;           ///< supernodes
  std::vector<int> selected_;      ///< columns
  std::vector<int> reached_;       ///< supernodes from the selected columns to the root, ascending
  ComplexVector work_;             ///< in the factor's order
  ComplexVector below_;            ///< rows below one supernode's triangle
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
