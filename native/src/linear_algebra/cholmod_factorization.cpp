#include "linear_algebra/cholmod_factorization.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <cholmod.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <numeric>
#include <utility>
#include <vector>

#include "concurrency/parallel_calls.h"
#include "graph/adjacency.h"
#include "graph/numbering.h"
#include "linear_algebra/blas_threads.h"
#include "linear_algebra/nested_dissection.h"
#include "linear_algebra/supernodal_factor.h"
#include "linear_algebra/symbolic_factor.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// CHOLMOD's workspace and settings for one thread.
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
    if (common_.status == CHOLMOD_TOO_LARGE) check_factor_size(infinity);
    if (common_.status < CHOLMOD_OK) {
      throw SolveFailure(rejected(Rejection::library_failed, common_.status));
    }
  }

 private:
  cholmod_common common_{};
};

cholmod_sparse lower_pattern(int n, const int* first, const int* rows) {
  cholmod_sparse pattern{};
  pattern.nrow = static_cast<std::size_t>(n);
  pattern.ncol = static_cast<std::size_t>(n);
  pattern.nzmax = static_cast<std::size_t>(first[n]);
  pattern.p = const_cast<int*>(first);
  pattern.i = const_cast<int*>(rows);
  pattern.stype = -1;
  pattern.itype = CHOLMOD_INT;
  pattern.xtype = CHOLMOD_PATTERN;
  pattern.dtype = CHOLMOD_DOUBLE;
  pattern.sorted = 1;
  pattern.packed = 1;
  return pattern;
}

cholmod_sparse view_of(const HermitianMatrix& matrix) {
  return lower_pattern(static_cast<int>(matrix.rows()), matrix.outerIndexPtr(), matrix.innerIndexPtr());
}

/// See CHOLMOD's User Guide, section "The cholmod_factor object".
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

/// An ordering, with the structure and cost of its factor.
struct CholmodAnalysis {
  SupernodalStructure structure;
  double multiplications = 0;  ///< of real numbers
};

/// ordering: CHOLMOD_AMD, CHOLMOD_NATURAL, or CHOLMOD_GIVEN with the order of the rows.
CholmodAnalysis analyze_pattern(const HermitianMatrix& matrix, int ordering, int* order = nullptr) {
  Workspace workspace;
  workspace->nmethods = 1;
  workspace->method[0].ordering = ordering;
  cholmod_sparse pattern = view_of(matrix);
  const auto free = [&](cholmod_factor* factor) { cholmod_free_factor(&factor, workspace.get()); };
  std::unique_ptr<cholmod_factor, decltype(free)> symbolic(nullptr, free);
  call_while_polling(matrix.nonZeros(),
                     [&] { symbolic.reset(cholmod_analyze_p(&pattern, order, nullptr, 0, workspace.get())); });
  workspace.check();
  return {structure_of(*symbolic), workspace->fl};
}

/// Orders the nodes of a leaf by AMD. position: of each node in the given order.
void order_leaf(const Adjacency& graph, const std::vector<int>& position, const std::array<int, 2>& leaf,
                std::vector<int>& order, Workspace& workspace) {
  const auto [begin, end] = leaf;
  std::vector<int> first{0};
  std::vector<int> rows;
  for (int i = begin; i < end; ++i) {
    for (const Adjacency::Arc arc : graph.arcs(order[i])) {
      // The lower triangle, without its diagonal.
      if (position[arc.to] > i && position[arc.to] < end) rows.push_back(position[arc.to] - begin);
    }
    first.push_back(static_cast<int>(rows.size()));
  }
  cholmod_sparse pattern = lower_pattern(end - begin, first.data(), rows.data());
  pattern.sorted = 0;
  std::vector<int> found(static_cast<std::size_t>(end - begin));
  if (!cholmod_amd(&pattern, nullptr, 0, found.data(), workspace.get())) workspace.check();
  for (int& node : found) node = order[begin + node];
  std::copy(found.begin(), found.end(), order.begin() + begin);
}

/// The order, with that of the leaves by AMD, several leaves per thread.
std::vector<int> with_ordered_leaves(const Adjacency& graph, NestedDissection dissection) {
  std::vector<int>& order = dissection.order;
  const std::vector<int> position = indices_in(order, order.size());
  // A leaf takes about this long, so each is a block.
  run_blocks_in_parallel(static_cast<int>(dissection.leaves.size()), 1, [&](int begin, int end) {
    Workspace workspace;
    for (int k = begin; k < end; ++k) order_leaf(graph, position, dissection.leaves[k], order, workspace);
  });
  return std::move(order);
}

/// With fewer rows, minimum degree alone is faster on most scanned shapes. entries: of the lower triangle.
double dissect_from(double n, double entries) {
  // With quads, whose two diagonals are both edges, AMD takes a third of the time.
  constexpr double max_entries_of_triangles = 4.25;
  return entries > max_entries_of_triangles * n ? 200000 : 100000;
}

/// Large matrices with positions are dissected. A plane cuts a surface coiled up in space along many lines, which
/// raises the multiplications; minimum degree is then tried too.
CholmodAnalysis analyze_in_best_order(const HermitianMatrix& matrix, const Adjacency& graph,
                                      const Positions* positions) {
  const auto n = static_cast<double>(matrix.rows());
  if (positions == nullptr || n < dissect_from(n, static_cast<double>(matrix.nonZeros()))) {
    return analyze_pattern(matrix, CHOLMOD_AMD);
  }
  std::vector<int> order = with_ordered_leaves(graph, nested_dissection(graph, *positions));
  CholmodAnalysis dissected = analyze_pattern(matrix, CHOLMOD_GIVEN, order.data());
  // Relative to n^(3/2): triangle grids take 10 to 18, quad grids 20 to 29.
  constexpr double many = 30;
  if (dissected.multiplications <= many * n * std::sqrt(n)) return dissected;
  CholmodAnalysis other = analyze_pattern(matrix, CHOLMOD_AMD);
  return other.multiplications < dissected.multiplications ? other : dissected;
}

/// By minimum degree, or, for large graphs with positions, by dissection.
std::vector<int> order_of(const Adjacency& graph, const Positions* positions) {
  NestedDissection dissection;
  if (positions != nullptr &&
      graph.n_nodes() >= dissect_from(graph.n_nodes(), 0.5 * graph.n_arcs() + graph.n_nodes())) {
    dissection = nested_dissection(graph, *positions);
  } else {
    dissection.order.resize(static_cast<std::size_t>(graph.n_nodes()));
    std::iota(dissection.order.begin(), dissection.order.end(), 0);
    dissection.leaves.push_back({0, graph.n_nodes()});
  }
  return with_ordered_leaves(graph, std::move(dissection));
}

/// Splits supernodes where real unknowns begin.
SupernodalStructure split_at(SupernodalStructure structure, const std::vector<char>& is_real) {
  SupernodalStructure result;
  result.order = std::move(structure.order);
  for (std::size_t k = 0; k + 1 < structure.first_column.size(); ++k) {
    const auto row = structure.rows.begin() + structure.first_row[k];
    const auto last_row = structure.rows.begin() + structure.first_row[k + 1];
    const auto begin = [&](int column) {
      result.first_column.push_back(column);
      result.first_row.push_back(static_cast<std::ptrdiff_t>(result.rows.size()));
      result.rows.insert(result.rows.end(), row + (column - structure.first_column[k]), last_row);
    };
    const auto is_real_column = [&](int column) { return is_real[result.order[column]] != 0; };
    begin(structure.first_column[k]);
    for (int column = structure.first_column[k] + 1; column < structure.first_column[k + 1]; ++column) {
      if (is_real_column(column) != is_real_column(column - 1)) begin(column);
    }
  }
  result.first_column.push_back(structure.first_column.back());
  result.first_row.push_back(static_cast<std::ptrdiff_t>(result.rows.size()));
  return result;
}

class CholmodFactorization final : public Factorization {
 public:
  using Factorization::analyze;
  void analyze(const HermitianMatrix& matrix, const Positions* positions) override {
    const Adjacency graph = graph_of(matrix);
    set_up(matrix, graph, analyze_in_best_order(matrix, graph, positions).structure, {});
  }

  std::vector<int> order(const Adjacency& graph, const Positions* positions) const override {
    return order_of(graph, positions);
  }
  void analyze_in_order(const HermitianMatrix& matrix, const std::vector<char>& is_real) override {
    SupernodalStructure structure = split_at(analyze_pattern(matrix, CHOLMOD_NATURAL).structure, is_real);
    set_up(matrix, graph_of(matrix), std::move(structure), is_real);
  }

  bool factorize(const HermitianMatrix& matrix) override { return factor_.factorize(matrix); }

  void solve(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads;
    for (Eigen::Index i = 0; i < work_.size(); ++i) work_[i] = b[symbolic().order()[i]];
    factor_.forward(all_, work_);
    factor_.backward(all_, work_);
    permute_back(x);
  }

  void select(std::vector<int> vertices) override {
    std::vector<int> index(static_cast<std::size_t>(symbolic().n()));
    for (int i = 0; i < symbolic().n(); ++i) index[symbolic().order()[i]] = i;
    selected_.clear();
    for (const int vertex : vertices) selected_.push_back(index[vertex]);
    reached_ = symbolic().above(selected_);
  }

  void solve_selected(const ComplexVector& b, ComplexVector& x) override {
    const BlasThreads threads;
    for (const int k : reached_.supernodes()) {
      work_.segment(symbolic().first_column(k), symbolic().columns(k)).setZero();
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

  double factor_nonzeros() const override { return symbolic().nonzeros(); }

 private:
  const SymbolicFactor& symbolic() const { return factor_.symbolic(); }
  void set_up(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure,
              const std::vector<char>& is_real) {
    factor_.analyze(matrix, graph, std::move(structure), is_real);
    all_ = symbolic().whole();
    work_.setZero(symbolic().n());
  }
  void permute_back(ComplexVector& x) const {
    x.resize(work_.size());
    for (Eigen::Index i = 0; i < work_.size(); ++i) x[symbolic().order()[i]] = work_[i];
    poll(work_.size());
  }

  SupernodalFactor factor_;
  SymbolicFactor::Path all_;
  std::vector<int> selected_;     ///< columns
  SymbolicFactor::Path reached_;  ///< from the selected columns
  ComplexVector work_;            ///< in the factor's order
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

#include "spectral_conformal/errors.h"

namespace spectral_conformal {

bool has_cholmod() { return false; }

std::unique_ptr<Factorization> make_cholmod_factorization() { throw InvalidMesh(Rejection::no_cholmod); }

std::string cholmod_version_name() { return ""; }

}  // namespace spectral_conformal

#endif
