#include "linear_algebra/supernodal_factor.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"
#include "linear_algebra/blas_threads.h"

// BLAS and LAPACK, Fortran linkage.
extern "C" {
void dpotrf_(const char*, const int*, double*, const int*, int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*,
            double*, const int*);
void zpotrf_(const char*, const int*, void*, const int*, int*);
void ztrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const void*, const void*,
            const int*, void*, const int*);
void zherk_(const char*, const char*, const int*, const int*, const double*, const void*, const int*, const double*,
            void*, const int*);
void ztrsv_(const char*, const char*, const char*, const int*, const void*, const int*, void*, const int*);
void zgemv_(const char*, const int*, const int*, const void*, const void*, const int*, const void*, const int*,
            const void*, void*, const int*);
}

namespace spectral_conformal {
namespace {

constexpr int one = 1;
/// Less work is done before a second thread has begun: of a factorisation, in multiplications, and of a solve, in
/// entries of the factor.
constexpr double min_multiplications_to_share = 2e7;
constexpr double min_entries_to_share = 1e6;
/// The same of the analysis.
constexpr double min_columns_to_share = 20000;
/// Width times height squared of the largest front, and the columns of the widest, that are small.
constexpr double max_small_front = 8000;
/// Multiplications that take a tenth of a second or more: a caller with a listener leaves the front to another thread.
constexpr double long_front = 3e8;
/// Of a multiplication in large fronts, and of what else a small one costs for each of its supernode's entries.
constexpr double nanoseconds_of_multiplication = 0.2;
constexpr double nanoseconds_of_entry = 5;
constexpr double nanoseconds_of_solve = 2;
constexpr int max_small_width = 24;

/// still_working. Not where the BLAS is held alone: a listener may wait for a thread that waits for the BLAS.
void listen(double nanoseconds) {
  if (BlasThreads::serves_many()) still_working(nanoseconds);
}

/// A = L L^H in place, (n, n) lower. False when it is not positive definite.
bool eliminate_columns(int n, double* a, int stride) {
  int info = 0;
  dpotrf_("L", &n, a, &stride, &info);
  return info == 0;
}
bool eliminate_columns(int n, Complex* a, int stride) {
  int info = 0;
  zpotrf_("L", &n, a, &stride, &info);
  return info == 0;
}

/// B <- B L^-H, (m, n).
void divide(int m, int n, const double* l, double* b, int stride) {
  constexpr double unit = 1;
  dtrsm_("R", "L", "T", "N", &m, &n, &unit, l, &stride, b, &stride);
}
void divide(int m, int n, const Complex* l, Complex* b, int stride) {
  const Complex unit = 1;
  ztrsm_("R", "L", "C", "N", &m, &n, &unit, l, &stride, b, &stride);
}

/// C = -B B^H, (n, n) lower, B (n, k).
void multiply(int n, int k, const double* b, int stride, double* c) {
  constexpr double minus = -1;
  constexpr double zero = 0;
  dsyrk_("L", "N", &n, &k, &minus, b, &stride, &zero, c, &n);
}
void multiply(int n, int k, const Complex* b, int stride, Complex* c) {
  constexpr double minus = -1;
  constexpr double zero = 0;
  zherk_("L", "N", &n, &k, &minus, b, &stride, &zero, c, &n);
}

// Small fronts have the same three steps here. OpenBLAS locks a mutex of the process in each call, at which threads
// that factorise small matrices wait for each other: on two cores they were no faster than one.

template <class Scalar>
using Block = Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;

/// Whether a front has so few multiplications that calls would take longer.
bool is_small(int width, int height) { return static_cast<double>(width) * height * height <= max_small_front; }

template <class Scalar>
bool eliminate_small_columns(Block<Scalar> a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double pivot = std::real(a(j, j));
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot);
    a(j, j) = root;
    const Eigen::Index below = a.rows() - j - 1;
    auto column = a.col(j).tail(below);
    column *= 1 / root;
    for (Eigen::Index k = j + 1; k < a.cols(); ++k) {
      a.col(k).tail(a.rows() - k) -= column.tail(a.rows() - k) * Eigen::numext::conj(a(k, j));
    }
  }
  return true;
}

/// C = -B B^H, lower.
template <class Scalar>
void multiply_small(const Block<Scalar>& b, Block<Scalar> c) {
  for (Eigen::Index j = 0; j < c.cols(); ++j) {
    auto column = c.col(j).tail(c.rows() - j);
    column.setZero();
    for (Eigen::Index k = 0; k < b.cols(); ++k) column -= b.col(k).tail(c.rows() - j) * Eigen::numext::conj(b(j, k));
  }
}

/// b <- L^-1 b, and b <- L^-H b, (n,).
void solve_small_lower(int n, const Complex* l, int stride, Complex* b) {
  for (int j = 0; j < n; ++j, l += stride) {
    b[j] /= l[j].real();
    const double re = b[j].real();
    const double im = b[j].imag();
    for (int i = j + 1; i < n; ++i) {
      b[i] -= Complex(l[i].real() * re - l[i].imag() * im, l[i].real() * im + l[i].imag() * re);
    }
  }
}
void solve_small_upper(int n, const Complex* l, int stride, Complex* b) {
  for (int j = n - 1; j >= 0; --j) {
    const Complex* const column = l + static_cast<std::ptrdiff_t>(j) * stride;
    double re = b[j].real();
    double im = b[j].imag();
    for (int i = j + 1; i < n; ++i) {
      re -= column[i].real() * b[i].real() + column[i].imag() * b[i].imag();
      im -= column[i].real() * b[i].imag() - column[i].imag() * b[i].real();
    }
    b[j] = Complex(re, im) / column[j].real();
  }
}

template <class Scalar>
Scalar part_of(const Complex& value) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return value.real();
  } else {
    return value;
  }
}

// Solves with a real block and a complex vector. BLAS has them for real vectors only and would read the block twice.

/// b <- L^-1 b, (n,), and c <- c - B b, (m,), B standing below L in the block. Four columns at a time, so that c is
/// read and written a quarter as often.
void solve_lower(int n, int m, const double* block, int stride, Complex* b, Complex* c) {
  int j = 0;
  const auto column = [&](int at) { return block + static_cast<std::ptrdiff_t>(at) * stride; };
  for (; j + 4 <= n; j += 4) {
    const double* const l[] = {column(j), column(j + 1), column(j + 2), column(j + 3)};
    for (int p = 0; p < 4; ++p) {
      b[j + p] /= l[p][j + p];
      for (int q = p + 1; q < 4; ++q) b[j + q] -= l[p][j + q] * b[j + p];
    }
    const Complex x[] = {b[j], b[j + 1], b[j + 2], b[j + 3]};
    for (int i = j + 4; i < n; ++i) b[i] -= (l[0][i] * x[0] + l[1][i] * x[1]) + (l[2][i] * x[2] + l[3][i] * x[3]);
    for (int i = 0; i < m; ++i) {
      const int row = n + i;
      c[i] -= (l[0][row] * x[0] + l[1][row] * x[1]) + (l[2][row] * x[2] + l[3][row] * x[3]);
    }
  }
  for (; j < n; ++j) {
    const double* const l = column(j);
    b[j] /= l[j];
    for (int i = j + 1; i < n; ++i) b[i] -= l[i] * b[j];
    for (int i = 0; i < m; ++i) c[i] -= l[n + i] * b[j];
  }
}

/// b <- L^-H (b - B^H c). Four columns at a time, whose sums do not wait for each other.
void solve_upper(int n, int m, const double* block, int stride, Complex* b, const Complex* c) {
  int j = n;
  const auto column = [&](int at) { return block + static_cast<std::ptrdiff_t>(at) * stride; };
  for (; j % 4 != 0; --j) {
    const double* const l = column(j - 1);
    Complex sum = 0;
    for (int i = j; i < n; ++i) sum += l[i] * b[i];
    for (int i = 0; i < m; ++i) sum += l[n + i] * c[i];
    b[j - 1] = (b[j - 1] - sum) / l[j - 1];
  }
  for (; j > 0; j -= 4) {
    const double* const l[] = {column(j - 4), column(j - 3), column(j - 2), column(j - 1)};
    Complex sum[4] = {};
    for (int i = j; i < n; ++i) {
      for (int p = 0; p < 4; ++p) sum[p] += l[p][i] * b[i];
    }
    for (int i = 0; i < m; ++i) {
      for (int p = 0; p < 4; ++p) sum[p] += l[p][n + i] * c[i];
    }
    for (int p = 3; p >= 0; --p) {
      const int at = j - 4 + p;
      for (int q = p + 1; q < 4; ++q) sum[p] += l[p][j - 4 + q] * b[j - 4 + q];
      b[at] = (b[at] - sum[p]) / l[p][at];
    }
  }
}

/// Frees the memory, too.
void give_up(LargeVector<double>& values) { LargeVector<double>().swap(values); }

}  // namespace

void SupernodalFactor::analyze(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure) {
  count_analysis();
  structure_ = std::move(structure);
  const int n_super = static_cast<int>(structure_.first_column.size()) - 1;
  supernode_of_.resize(structure_.order.size());
  for (int k = 0; k < n_super; ++k) {
    std::fill(supernode_of_.begin() + first_column(k), supernode_of_.begin() + first_column(k + 1), k);
  }
  below_.resize(static_cast<Eigen::Index>(structure_.rows.size()));
  std::vector<int> place_of(structure_.order.size());
  for (int i = 0; i < n(); ++i) place_of[structure_.order[i]] = i;

  parent_.resize(n_super);
  place_.resize(structure_.rows.size());
  first_entry_.assign(n_super + 1, 0);
  std::vector<double> cost(n_super);
  const auto for_each_supernode = [&](const auto& visit) {
    constexpr int supernodes_at_once = 2000;
    constexpr double nanoseconds = 2000;
    run_blocks_in_parallel(
        n_super, supernodes_at_once, nanoseconds,
        [&](int begin, int end) {
          for (int k = begin; k < end; ++k) visit(k);
        },
        n_threads(n(), min_columns_to_share));
  };
  for_each_supernode([&](int k) {
    const double width = columns(k);
    const double height = rows(k);
    // Multiplications, and what the calls and the passing on of small blocks cost beside.
    cost[k] = width * height * height + 20 * height * height + 5000;
    for (int column = first_column(k); column < first_column(k + 1); ++column) {
      ++first_entry_[k + 1];
      for (const Adjacency::Arc arc : graph.arcs(structure_.order[column])) {
        if (place_of[arc.to] > column) ++first_entry_[k + 1];
      }
    }
    parent_[k] = rows(k) == columns(k) ? -1 : supernode_of_[row_indices(k)[columns(k)]];
    if (parent_[k] < 0) return;
    const int* const above = row_indices(parent_[k]);
    int at = 0;
    for (int i = columns(k); i < rows(k); ++i) {
      while (above[at] < row_indices(k)[i]) ++at;
      place_[structure_.first_row[k] + i] = at;
    }
  });

  first_child_.assign(n_super + 1, 0);
  for (const int parent : parent_) {
    if (parent >= 0) ++first_child_[parent + 1];
  }
  std::partial_sum(first_child_.begin(), first_child_.end(), first_child_.begin());
  children_.resize(static_cast<std::size_t>(first_child_.back()));
  std::vector<int> end(first_child_.begin(), first_child_.end() - 1);
  for (int k = 0; k < n_super; ++k) {
    if (parent_[k] >= 0) children_[end[parent_[k]]++] = k;
  }
  schedule_ = ForestSchedule(parent_, cost);
  listen(100.0 * n_super);

  std::partial_sum(first_entry_.begin(), first_entry_.end(), first_entry_.begin());
  entries_.resize(static_cast<std::size_t>(matrix.nonZeros()));
  for_each_supernode([&](int k) {
    Entry* entry = entries_.data() + first_entry_[k];
    for (int column = first_column(k); column < first_column(k + 1); ++column) {
      const int v = structure_.order[column];
      const int in_block = column - first_column(k);
      *entry++ = {matrix.outerIndexPtr()[v], in_block + in_block * rows(k)};
      for (const Adjacency::Arc arc : graph.arcs(v)) {
        const int place = place_of[arc.to];
        if (place <= column) continue;
        const auto row = std::lower_bound(row_indices(k) + in_block, row_indices(k) + rows(k), place) - row_indices(k);
        *entry++ = {arc.to > v ? arc.edge : ~arc.edge, static_cast<int>(row) + in_block * rows(k)};
      }
    }
  });
}

double SupernodalFactor::nonzeros() const {
  double sum = 0;
  for (int k = 0; k < n_supernodes(); ++k) sum += static_cast<double>(rows(k)) * columns(k);
  return sum;
}

double SupernodalFactor::multiplications() const {
  double sum = 0;
  for (int k = 0; k < n_supernodes(); ++k) {
    double of_real = 0;
    for (int column = 0; column < columns(k); ++column) {
      const double below = rows(k) - column;
      of_real += below * (below + 1) / 2;
    }
    sum += is_real_[k] ? of_real : 4 * of_real;
  }
  return sum;
}

double SupernodalFactor::n_doubles(const Path& path) const {
  double sum = 0;
  for (const int k : path.supernodes_) sum += static_cast<double>(offset_[k + 1] - offset_[k]);
  return sum;
}

bool SupernodalFactor::factorize(const HermitianMatrix& matrix) {
  const int n_super = n_supernodes();
  listen(5 * static_cast<double>(matrix.nonZeros()));
  is_real_.assign(n_super, 1);
  offset_.assign(n_super + 1, 0);
  for (int k = 0; k < n_super; ++k) {
    for (int e = first_entry_[k]; e < first_entry_[k + 1] && is_real_[k]; ++e) {
      const int source = entries_[e].source;
      is_real_[k] = matrix.valuePtr()[source < 0 ? ~source : source].imag() == 0;
    }
    if (!is_real_[k] && parent_[k] >= 0) is_real_[parent_[k]] = 0;
    offset_[k + 1] = offset_[k] + static_cast<std::ptrdiff_t>(rows(k)) * columns(k) * (is_real_[k] ? 1 : 2);
  }
  if (values_.size() < static_cast<std::size_t>(offset_.back())) {
    give_up(values_);
    values_.resize(static_cast<std::size_t>(offset_.back()));
  }
  passed_.clear();
  passed_.resize(n_super);
  std::atomic<bool> is_definite{true};
  count_factorization(multiplications());
  const BlasThreads blas;
  schedule_.run_up(
      n_threads(schedule_.cost(), min_multiplications_to_share),
      [&](int k) {
        if (!is_definite) return;
        const bool done = is_real_[k] ? eliminate<double>(k, matrix) : eliminate<Complex>(k, matrix);
        if (!done) is_definite = false;
      },
      long_front);
  passed_.clear();
  return is_definite;
}

unsigned SupernodalFactor::n_threads(double work, double min_work) const {
  if (!BlasThreads::serves_many()) return 1;
  if (max_threads_ > 0) return max_threads_;
  return work < min_work ? 1 : all_threads;
}

template <class Scalar>
bool SupernodalFactor::eliminate(int k, const HermitianMatrix& matrix) {
  const int width = columns(k);
  const int height = rows(k);
  const int below = height - width;
  auto* const own = reinterpret_cast<Scalar*>(block(k));
  std::fill(own, own + static_cast<std::ptrdiff_t>(width) * height, Scalar(0));
  for (int e = first_entry_[k]; e < first_entry_[k + 1]; ++e) {
    const int source = entries_[e].source;
    const Complex value = source < 0 ? std::conj(matrix.valuePtr()[~source]) : matrix.valuePtr()[source];
    own[entries_[e].target] = part_of<Scalar>(value);
  }
  for_each_child<Scalar>(k, [&](int child, const auto* from) { add_to_columns(child, from, own, height, width); });
  const bool small = is_small(width, height);
  const auto worked = [&](double multiplications) {
    constexpr double real_ones = std::is_same_v<Scalar, double> ? 1 : 4;
    listen(nanoseconds_of_multiplication * real_ones * multiplications);
  };
  listen(nanoseconds_of_entry * width * height);
  if (small) {
    // With the rows below, which are divided by the way.
    if (!eliminate_small_columns<Scalar>({own, height, width, Eigen::OuterStride<>(height)})) return false;
  } else if (!eliminate_columns(width, own, height)) {
    return false;
  }
  if (below == 0) {
    for (int i = first_child_[k]; i < first_child_[k + 1]; ++i) give_up(passed_[children_[i]]);
    return true;
  }
  if (!small) {
    worked(static_cast<double>(width) * width * width / 3);
    divide(below, width, own, own + width, height);
    worked(static_cast<double>(below) * width * width);
  }
  constexpr int doubles = std::is_same_v<Scalar, double> ? 1 : 2;
  passed_[k].resize(static_cast<std::size_t>(below) * static_cast<std::size_t>(below * doubles));
  auto* const passed = reinterpret_cast<Scalar*>(passed_[k].data());
  if (small) {
    multiply_small<Scalar>({own + width, below, width, Eigen::OuterStride<>(height)},
                           {passed, below, below, Eigen::OuterStride<>(below)});
  } else {
    multiply(below, width, own + width, height, passed);
    worked(0.5 * below * below * width);
  }
  for_each_child<Scalar>(k, [&](int child, const auto* from) {
    add_below(child, from, passed, below, width);
    give_up(passed_[child]);
  });
  listen(nanoseconds_of_entry * below * below);
  return true;
}

/// Calls visit(child, what it passes on), which is complex only where the parent is.
template <class Scalar, class Visit>
void SupernodalFactor::for_each_child(int k, const Visit& visit) {
  for (int i = first_child_[k]; i < first_child_[k + 1]; ++i) {
    const int child = children_[i];
    const double* const from = passed_[child].data();
    if constexpr (std::is_same_v<Scalar, Complex>) {
      if (!is_real_[child]) {
        visit(child, reinterpret_cast<const Complex*>(from));
        continue;
      }
    }
    visit(child, from);
  }
}

/// To the columns of the parent.
template <class Scalar, class OfChild>
void SupernodalFactor::add_to_columns(int child, const OfChild* from, Scalar* own, int height, int width) const {
  const int* const place = place_in_parent(child) + columns(child);
  const int n = rows(child) - columns(child);
  for (int j = 0; j < n && place[j] < width; ++j) {
    const OfChild* const column = from + static_cast<std::ptrdiff_t>(j) * n;
    Scalar* const target = own + static_cast<std::ptrdiff_t>(place[j]) * height;
    for (int i = j; i < n; ++i) target[place[i]] += column[i];
  }
}

/// To what the parent passes on itself.
template <class Scalar, class OfChild>
void SupernodalFactor::add_below(int child, const OfChild* from, Scalar* passed, int height, int width) const {
  const int* const place = place_in_parent(child) + columns(child);
  const int n = rows(child) - columns(child);
  const int first = static_cast<int>(std::lower_bound(place, place + n, width) - place);
  for (int j = first; j < n; ++j) {
    const OfChild* const column = from + static_cast<std::ptrdiff_t>(j) * n;
    Scalar* const target = passed + static_cast<std::ptrdiff_t>(place[j] - width) * height;
    for (int i = j; i < n; ++i) target[place[i] - width] += column[i];
  }
}

SupernodalFactor::Path SupernodalFactor::whole() const {
  std::vector<int> all(parent_.size());
  std::iota(all.begin(), all.end(), 0);
  return path_of(std::move(all));
}

SupernodalFactor::Path SupernodalFactor::above(const std::vector<int>& columns) const {
  std::vector<char> is_reached(parent_.size(), 0);
  for (const int column : columns) {
    for (int k = supernode_of_[column]; k >= 0 && !is_reached[k]; k = parent_[k]) is_reached[k] = 1;
  }
  std::vector<int> reached;
  for (int k = 0; k < n_supernodes(); ++k) {
    if (is_reached[k]) reached.push_back(k);
  }
  return path_of(std::move(reached));
}

SupernodalFactor::Path SupernodalFactor::path_of(std::vector<int> supernodes) const {
  Path path;
  path.is_member_.assign(parent_.size(), 0);
  std::vector<int> place(parent_.size(), -1);
  for (std::size_t i = 0; i < supernodes.size(); ++i) {
    path.is_member_[supernodes[i]] = 1;
    place[supernodes[i]] = static_cast<int>(i);
  }
  std::vector<int> parent;
  std::vector<double> cost;
  parent.reserve(supernodes.size());
  cost.reserve(supernodes.size());
  for (const int k : supernodes) {
    parent.push_back(parent_[k] < 0 ? -1 : place[parent_[k]]);
    cost.push_back(static_cast<double>(rows(k)) * columns(k));
  }
  path.schedule_ = ForestSchedule(parent, cost);
  path.supernodes_ = std::move(supernodes);
  return path;
}

void SupernodalFactor::forward(const Path& path, ComplexVector& work) {
  const Complex minus(-1);
  const Complex unit(1);
  count_solve(n_doubles(path));
  path.schedule_.run_up(n_threads(path.schedule_.cost(), min_entries_to_share), [&](int member) {
    const int k = path.supernodes_[member];
    const int width = columns(k);
    const int height = rows(k);
    const int below = height - width;
    listen(nanoseconds_of_solve * width * height);
    Complex* const own = work.data() + first_column(k);
    Complex* const passed = below_.data() + structure_.first_row[k] + width;
    std::fill(passed, passed + below, Complex(0));
    for (int i = first_child_[k]; i < first_child_[k + 1]; ++i) {
      const int child = children_[i];
      if (!path.is_member_[child]) continue;
      const Complex* const from = below_.data() + structure_.first_row[child];
      const int* const place = place_in_parent(child);
      int row = columns(child);
      for (; row < rows(child) && place[row] < width; ++row) own[place[row]] += from[row];
      for (; row < rows(child); ++row) passed[place[row] - width] += from[row];
    }
    if (is_real_[k]) {
      solve_lower(width, below, block(k), height, own, passed);
      return;
    }
    const auto* const values = reinterpret_cast<const Complex*>(block(k));
    if (width <= max_small_width) {
      solve_small_lower(width, values, height, own);
    } else {
      ztrsv_("L", "N", "N", &width, values, &height, own, &one);
    }
    if (below > 0) zgemv_("N", &below, &width, &minus, values + width, &height, own, &one, &unit, passed, &one);
  });
}

void SupernodalFactor::backward(const Path& path, ComplexVector& work) {
  const Complex minus(-1);
  const Complex unit(1);
  count_solve(n_doubles(path));
  path.schedule_.run_down(n_threads(path.schedule_.cost(), min_entries_to_share), [&](int member) {
    const int k = path.supernodes_[member];
    const int width = columns(k);
    const int height = rows(k);
    const int below = height - width;
    listen(nanoseconds_of_solve * width * height);
    Complex* const own = work.data() + first_column(k);
    Complex* const above = below_.data() + structure_.first_row[k] + width;
    for (int i = 0; i < below; ++i) above[i] = work[row_indices(k)[width + i]];
    if (is_real_[k]) {
      solve_upper(width, below, block(k), height, own, above);
      return;
    }
    const auto* const values = reinterpret_cast<const Complex*>(block(k));
    if (below > 0) zgemv_("C", &below, &width, &minus, values + width, &height, above, &one, &unit, own, &one);
    if (width <= max_small_width) {
      solve_small_upper(width, values, height, own);
    } else {
      ztrsv_("L", "C", "N", &width, values, &height, own, &one);
    }
  });
}

}  // namespace spectral_conformal

#endif
