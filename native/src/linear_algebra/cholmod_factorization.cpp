#include "linear_algebra/cholmod_factorization.h"

#include <stdexcept>

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <cholmod.h>

#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "graph/parallel_calls.h"
#include "linear_algebra/blas_threads.h"
#include "linear_algebra/distance_numbering.h"
#include "linear_algebra/supernodal_factor.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// CHOLMOD's workspace and settings, of one thread.
class Workspace {
 public:
  Workspace() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.postorder = 1;
  }
  ~Workspace() { cholmod_finish(&common_); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  cholmod_common* operator->() { return &common_; }
  cholmod_common* get() { return &common_; }
  void check() const {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common_.status == CHOLMOD_TOO_LARGE) check_factor_size(std::numeric_limits<double>::infinity());
    if (common_.status < CHOLMOD_OK) {
      throw SolveFailure("CHOLMOD reported status " + std::to_string(common_.status),
                         "please report this with the mesh.");
    }
  }

 private:
  cholmod_common common_{};
};

cholmod_sparse view_of(const HermitianMatrix& matrix) {
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

/// CHOLMOD's User Guide, section "The cholmod_factor object".
SupernodalStructure structure_of(const cholmod_factor& symbolic) {
  const auto* const order = static_cast<const int*>(symbolic.Perm);
  const auto* const first_column = static_cast<const int*>(symbolic.super);
  const auto* const first_row = static_cast<const int*>(symbolic.pi);
  const auto* const rows = static_cast<const int*>(symbolic.s);
  return {{order, order + symbolic.n},
          {first_column, first_column + symbolic.nsuper + 1},
          {first_row, first_row + symbolic.nsuper + 1},
          {rows, rows + first_row[symbolic.nsuper]}};
}

/// An ordering, and what a factor in it is like.
struct SymbolicFactor {
  SupernodalStructure structure;
  double multiplications = 0;  ///< of real numbers
};

SymbolicFactor analyze_pattern(cholmod_sparse& pattern, Workspace& workspace) {
  const auto free = [&](cholmod_factor* factor) { cholmod_free_factor(&factor, workspace.get()); };
  const std::unique_ptr<cholmod_factor, decltype(free)> symbolic(cholmod_analyze(&pattern, workspace.get()), free);
  workspace.check();
  return {structure_of(*symbolic), workspace->fl};
}

/// From so many rows on CHOLMOD tries METIS, too, where AMD seems poor; it takes ten times as long and saves memory
/// (0.71 instead of 1.08 GB).
constexpr Eigen::Index compare_from = 600000;

SymbolicFactor as_numbered(const HermitianMatrix& matrix) {
  Workspace workspace;
  workspace->nmethods = matrix.rows() < compare_from ? 1 : 0;
  workspace->method[0].ordering = CHOLMOD_AMD;
  cholmod_sparse view = view_of(matrix);
  return analyze_pattern(view, workspace);
}

/// By AMD, with the rows numbered otherwise before.
SymbolicFactor by_distance(const HermitianMatrix& matrix) {
  Workspace workspace;
  workspace->nmethods = 1;
  workspace->method[0].ordering = CHOLMOD_AMD;
  std::vector<int> numbering = numbering_by_distance(matrix);
  cholmod_sparse view = view_of(matrix);
  const auto free = [&](cholmod_sparse* sparse) { cholmod_free_sparse(&sparse, workspace.get()); };
  const std::unique_ptr<cholmod_sparse, decltype(free)> renumbered(
      cholmod_ptranspose(&view, 0, numbering.data(), nullptr, 0, workspace.get()), free);
  workspace.check();
  SymbolicFactor result = analyze_pattern(*renumbered, workspace);
  for (int& row : result.structure.order) row = numbering[static_cast<std::size_t>(row)];
  return result;
}

class CholmodFactorization final : public Factorization {
 public:
  void analyze(const HermitianMatrix& matrix) override {
    // AMD breaks ties by the numbers of rows. On quads in rows, whose vertices are all alike, either numbering may need
    // twice the multiplications of the other: of 731 x 731 vertices 23e9 and 8e9, of 700 x 700 8e9 and 14e9, as CHOLMOD
    // counts them. Two threads try both; below, it costs as much as it saves.
    constexpr Eigen::Index worth_it = 40000;
    const int n_orderings = matrix.rows() >= worth_it && matrix.rows() < compare_from ? 2 : 1;
    SymbolicFactor found[2];
    run_in_parallel(
        n_orderings, 2, [&](int i, const Progress&) { found[i] = i == 0 ? as_numbered(matrix) : by_distance(matrix); },
        {}, "");
    const bool second = n_orderings == 2 && found[1].multiplications < found[0].multiplications;
    factor_.analyze(matrix, std::move(found[second ? 1 : 0].structure));
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
  void permute_back(ComplexVector& x) const {
    x.resize(work_.size());
    for (Eigen::Index i = 0; i < work_.size(); ++i) x[factor_.order()[i]] = work_[i];
  }

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
