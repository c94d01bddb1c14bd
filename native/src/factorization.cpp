#include "spectral_conformal/factorization.h"

#include <Eigen/SparseCholesky>
#include <mutex>
#include <new>
#include <stdexcept>

#include "spectral_conformal/errors.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
#include <cholmod.h>
#if defined(__unix__) || defined(__APPLE__)
#include <dlfcn.h>
#endif
// The LAPACK routine whose address tells which library serves CHOLMOD; Fortran linkage.
extern "C" void zpotrf_(const char*, const int*, void*, const int*, int*);
#endif

namespace spectral_conformal {
namespace {

class EigenFactorization final : public Factorization {
 public:
  void analyze(const HermitianMatrix& matrix) override { ldlt_.analyzePattern(matrix); }

  bool factorize(const HermitianMatrix& matrix) override {
    ldlt_.factorize(matrix);
    // L D L^H also exists for some indefinite matrices: positive definite means positive pivots.
    return ldlt_.info() == Eigen::Success && (ldlt_.vectorD().real().array() > 0).all();
  }

  void solve(const ComplexVector& b, ComplexVector& x) override { x = ldlt_.solve(b); }

  double factor_nonzeros() const override {
    const HermitianMatrix& factor = ldlt_.matrixL().nestedExpression();
    return static_cast<double>(factor.nonZeros());
  }

 private:
  Eigen::SimplicialLDLT<HermitianMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> ldlt_;
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

/// Holds OpenBLAS to one thread while any object lives, and restores its setting after the last one: more threads gain
/// nothing on these supernodes, and the result must not depend on their number. OpenBLAS has one setting for the whole
/// process, which is why the count of holders is shared.
class SingleThreadedBlas {
 public:
  explicit SingleThreadedBlas(const Blas& blas) : blas_(blas) {
    const std::lock_guard<std::mutex> lock(mutex());
    const auto get = blas_.function<int (*)()>("openblas_get_num_threads");
    if (holders()++ == 0 && get != nullptr) before() = get();
    set(1);
  }
  ~SingleThreadedBlas() {
    const std::lock_guard<std::mutex> lock(mutex());
    if (--holders() == 0) set(before());
  }
  SingleThreadedBlas(const SingleThreadedBlas&) = delete;
  SingleThreadedBlas& operator=(const SingleThreadedBlas&) = delete;

 private:
  void set(int threads) const {
    if (const auto set = blas_.function<void (*)(int)>("openblas_set_num_threads")) set(threads);
  }
  static std::mutex& mutex() {
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
};

#else

struct Blas {};
struct SingleThreadedBlas {
  explicit SingleThreadedBlas(const Blas&) {}
};

#endif

class CholmodFactorization final : public Factorization {
 public:
  CholmodFactorization() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.nmethods = 1;
    common_.postorder = 1;
  }
  ~CholmodFactorization() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_dense(&solution_, &common_);
    cholmod_free_dense(&work_1_, &common_);
    cholmod_free_dense(&work_2_, &common_);
    cholmod_finish(&common_);
  }
  CholmodFactorization(const CholmodFactorization&) = delete;
  CholmodFactorization& operator=(const CholmodFactorization&) = delete;

  void analyze(const HermitianMatrix& matrix) override {
    cholmod_free_factor(&factor_, &common_);
    // Nested dissection pays for its slower ordering from here on, in time and in memory.
    constexpr Eigen::Index metis_from = 250000;
    common_.method[0].ordering = matrix.rows() >= metis_from ? CHOLMOD_METIS : CHOLMOD_AMD;
    cholmod_sparse view = view_of(matrix);
    factor_ = cholmod_analyze(&view, &common_);
    check();
  }

  bool factorize(const HermitianMatrix& matrix) override {
    const SingleThreadedBlas single(blas_);
    cholmod_sparse view = view_of(matrix);
    cholmod_factorize(&view, factor_, &common_);
    if (common_.status == CHOLMOD_NOT_POSDEF) return false;
    check();
    return true;
  }

  void solve(const ComplexVector& b, ComplexVector& x) override {
    const SingleThreadedBlas single(blas_);
    cholmod_dense rhs{};
    rhs.nrow = static_cast<std::size_t>(b.size());
    rhs.ncol = 1;
    rhs.nzmax = rhs.nrow;
    rhs.d = rhs.nrow;
    rhs.x = const_cast<Complex*>(b.data());  // CHOLMOD's interface has no const; it only reads
    rhs.xtype = CHOLMOD_COMPLEX;
    rhs.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &rhs, nullptr, &solution_, nullptr, &work_1_, &work_2_, &common_);
    check();
    x = Eigen::Map<const ComplexVector>(static_cast<const Complex*>(solution_->x), b.size());
  }

  double factor_nonzeros() const override { return static_cast<double>(factor_->xsize); }

 private:
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
    if (common_.status == CHOLMOD_TOO_LARGE) {
      throw SolveFailure("The patch is too large for this build's index type; cut it into smaller islands with seams.");
    }
    if (common_.status < CHOLMOD_OK) {
      throw SolveFailure("CHOLMOD reported status " + std::to_string(common_.status) + ".");
    }
  }

  Blas blas_;
  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_1_ = nullptr;
  cholmod_dense* work_2_ = nullptr;
};

#endif

}  // namespace

std::unique_ptr<Factorization> make_factorization(FactorizationBackend backend) {
#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD
  if (backend != FactorizationBackend::eigen) return std::make_unique<CholmodFactorization>();
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
