#include "linear_algebra/factorization.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <mutex>
#include <new>
#include <shared_mutex>
#include <stdexcept>

#include "spectral_conformal/errors.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
#include <cholmod.h>
#if defined(__unix__) || defined(__APPLE__)
#include <dlfcn.h>
#endif
// BLAS and LAPACK, Fortran linkage. The address of zpotrf_ tells which library serves CHOLMOD.
extern "C" {
void zpotrf_(const char*, const int*, void*, const int*, int*);
void ztrsv_(const char*, const char*, const char*, const int*, const void*, const int*, void*, const int*);
void zgemv_(const char*, const int*, const int*, const void*, const void*, const int*, const void*, const int*,
            const void*, void*, const int*);
}
#endif

namespace spectral_conformal {
namespace {

/// Tells the size of the factor, which Eigen counts with ints, before there is one.
class SimplicialLdlt : public Eigen::SimplicialLDLT<HermitianMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> {
 public:
  double planned_nonzeros() const { return m_nonZerosPerCol.cast<double>().sum(); }
};

class EigenFactorization final : public Factorization {
 public:
  void analyze(const HermitianMatrix& matrix) override {
    ldlt_.analyzePattern(matrix);
    check_factor_size(ldlt_.planned_nonzeros());
  }

  bool factorize(const HermitianMatrix& matrix) override {
    ldlt_.factorize(matrix);
    // L D L^H also exists for some indefinite matrices: positive definite means positive pivots.
    return ldlt_.info() == Eigen::Success && (ldlt_.vectorD().real().array() > 0).all();
  }

  void solve(const ComplexVector& b, ComplexVector& x) override { x = ldlt_.solve(b); }

  void select(std::vector<int> vertices) override { selected_ = std::move(vertices); }

  void solve_selected(const ComplexVector& b, ComplexVector& x) override {
    ComplexVector full;
    solve_from_selected(b, full);
    x.resize(b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = full[selected_[i]];
  }

  void solve_from_selected(const ComplexVector& b, ComplexVector& x) override {
    ComplexVector full = ComplexVector::Zero(ldlt_.rows());
    for (Eigen::Index i = 0; i < b.size(); ++i) full[selected_[i]] = b[i];
    x = ldlt_.solve(full);
  }

  double factor_nonzeros() const override {
    const HermitianMatrix& factor = ldlt_.matrixL().nestedExpression();
    return static_cast<double>(factor.nonZeros());
  }

 private:
  SimplicialLdlt ldlt_;
  std::vector<int> selected_;
};

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#if defined(__unix__) || defined(__APPLE__)

/// The loaded library that serves CHOLMOD's LAPACK and BLAS calls, and its file; null when it cannot be told.
struct Blas {
  void* handle = nullptr;
  std::string file;
  Blas() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&zpotrf_), &info) == 0 || info.dli_fname == nullptr) return;
    file = info.dli_fname;
    handle = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  }
  ~Blas() {
    if (handle != nullptr) dlclose(handle);
  }
  Blas(const Blas&) = delete;
  Blas& operator=(const Blas&) = delete;
  /// A function of OpenBLAS, or null in any other BLAS.
  template <class Function>
  Function function(const char* name) const {
    return handle == nullptr ? nullptr : reinterpret_cast<Function>(dlsym(handle, name));
  }
};

/// Holds OpenBLAS to a number of threads that depends on the task alone while the object lives, and restores its
/// setting: the result must not depend on how many the machine or the user set. One thread for all but the larger
/// factorisations, where a second gains a third; on small fronts it gains nothing and stalls while the other core is
/// busy. OpenBLAS has one setting for the whole process, so its holders share a lock: any number with one thread, or
/// one with two. OpenBLAS built without threads (openblas_get_parallel() == 0) must not be called by two threads at
/// once at all: then there is one holder at a time.
class FixedBlasThreads {
 public:
  enum class Count { one, two };

  FixedBlasThreads(const Blas& blas, Count count)
      : blas_(blas), exclusive_(count == Count::two || call("openblas_get_parallel", 1) == 0) {
    if (exclusive_) {
      gate().lock();
      previous_ = call("openblas_get_num_threads", 1);
      set(count == Count::two ? 2 : 1);
      return;
    }
    gate().lock_shared();
    const std::lock_guard<std::mutex> lock(counting());
    if (holders()++ == 0) {
      before() = call("openblas_get_num_threads", 1);
      set(1);
    }
  }
  ~FixedBlasThreads() {
    if (exclusive_) {
      set(previous_);
      gate().unlock();
      return;
    }
    {
      const std::lock_guard<std::mutex> lock(counting());
      if (--holders() == 0) set(before());
    }
    gate().unlock_shared();
  }
  FixedBlasThreads(const FixedBlasThreads&) = delete;
  FixedBlasThreads& operator=(const FixedBlasThreads&) = delete;

 private:
  /// What OpenBLAS answers; `otherwise` in any other BLAS.
  int call(const char* name, int otherwise) const {
    const auto function = blas_.function<int (*)()>(name);
    return function == nullptr ? otherwise : function();
  }
  void set(int threads) const {
    if (const auto function = blas_.function<void (*)(int)>("openblas_set_num_threads")) function(threads);
  }
  static std::shared_mutex& gate() {
    static std::shared_mutex shared;
    return shared;
  }
  static std::mutex& counting() {
    static std::mutex shared;
    return shared;
  }
  static int& holders() {
    static int shared = 0;
    return shared;
  }
  static int& before() {
    static int shared = 1;
    return shared;
  }
  const Blas& blas_;
  const bool exclusive_;
  int previous_ = 1;
};

#else

struct Blas {};
struct FixedBlasThreads {
  enum class Count { one, two };
  FixedBlasThreads(const Blas&, Count) {}
};

#endif

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
    // AMD alone is fastest while its factor fits comfortably; beyond, CHOLMOD compares it with METIS (its own default
    // strategy), which takes longer to order and less memory.
    constexpr Eigen::Index compare_from = 600000;
    common_.nmethods = matrix.rows() < compare_from ? 1 : 0;
    common_.method[0].ordering = CHOLMOD_AMD;
    cholmod_sparse view = view_of(matrix);
    factor_ = cholmod_analyze(&view, &common_);
    check();
    supernode_of_.resize(factor_->n);
    all_.resize(factor_->nsuper);
    int most_rows = 0;
    for (int k = 0; k < static_cast<int>(factor_->nsuper); ++k) {
      all_[k] = k;
      most_rows = std::max(most_rows, rows(k));
      for (int column = first_column(k); column < first_column(k + 1); ++column) supernode_of_[column] = k;
    }
    work_.setZero(static_cast<Eigen::Index>(factor_->n));
    below_.resize(most_rows);
  }

  bool factorize(const HermitianMatrix& matrix) override {
    constexpr std::size_t two_from = 40000;
    const auto count = factor_->n < two_from ? FixedBlasThreads::Count::one : FixedBlasThreads::Count::two;
    const FixedBlasThreads threads(blas_, count);
    cholmod_sparse view = view_of(matrix);
    cholmod_factorize(&view, factor_, &common_);
    if (common_.status == CHOLMOD_NOT_POSDEF) return false;
    check();
    return true;
  }

  void solve(const ComplexVector& b, ComplexVector& x) override {
    const FixedBlasThreads threads(blas_, FixedBlasThreads::Count::one);
    const int* order = permutation();
    for (std::size_t i = 0; i < factor_->n; ++i) work_[static_cast<Eigen::Index>(i)] = b[order[i]];
    forward(all_);
    backward(all_);
    permute_back(x);
  }

  void select(std::vector<int> vertices) override {
    std::vector<int> place(factor_->n);
    for (std::size_t i = 0; i < factor_->n; ++i) place[permutation()[i]] = static_cast<int>(i);
    selected_.clear();
    for (const int vertex : vertices) selected_.push_back(place[vertex]);
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
    const FixedBlasThreads threads(blas_, FixedBlasThreads::Count::one);
    for (const int k : reached_) work_.segment(first_column(k), columns(k)).setZero();
    for (Eigen::Index i = 0; i < b.size(); ++i) work_[selected_[i]] = b[i];
    forward(reached_);
    backward(reached_);
    x.resize(b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = work_[selected_[i]];
  }

  void solve_from_selected(const ComplexVector& b, ComplexVector& x) override {
    const FixedBlasThreads threads(blas_, FixedBlasThreads::Count::one);
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

  Blas blas_;
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  std::vector<int> supernode_of_;  ///< of each column
  std::vector<int> all_;           ///< supernodes
  std::vector<int> selected_;      ///< columns
  std::vector<int> reached_;       ///< supernodes from the selected columns to the root, ascending
  ComplexVector work_;             ///< in the factor's order
  ComplexVector below_;            ///< rows below one supernode's triangle
};

#endif

}  // namespace

void check_factor_size(double nonzeros) {
  constexpr int limit = std::numeric_limits<int>::max();
  if (nonzeros <= limit) return;
  throw SolveFailure("The patch is too large: its factor would have more than " + std::to_string(limit) + " entries",
                     "cut it into smaller islands with seams.");
}

std::unique_ptr<Factorization> make_factorization(FactorizationBackend backend, [[maybe_unused]] Eigen::Index n) {
#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
  // Setting CHOLMOD up takes longer than Eigen takes for a small matrix.
  constexpr Eigen::Index cholmod_from = 300;
  if (backend == FactorizationBackend::cholmod || (backend == FactorizationBackend::automatic && n >= cholmod_from)) {
    return std::make_unique<CholmodFactorization>();
  }
#else
  if (backend == FactorizationBackend::cholmod) {
    throw std::invalid_argument("This build has no CHOLMOD; install SuiteSparse and build again, or use 'eigen'.");
  }
#endif
  return std::make_unique<EigenFactorization>();
}

std::string factorization_library() {
#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
  int version[3];
  cholmod_version(version);
  return "CHOLMOD " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]);
#else
  return "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
#endif
}

std::string blas_library() {
#if defined(SPECTRAL_CONFORMAL_HAVE_CHOLMOD) && (defined(__unix__) || defined(__APPLE__))
  const Blas blas;
  const auto config = blas.function<const char* (*)()>("openblas_get_config");
  return config == nullptr ? blas.file : blas.file + " (" + config() + ")";
#else
  return "";
#endif
}

}  // namespace spectral_conformal
