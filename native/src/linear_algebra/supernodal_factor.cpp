#include "linear_algebra/supernodal_factor.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"
#include "linear_algebra/blas_threads.h"

namespace spectral_conformal {
namespace {

/// Of multiplications in large fronts, and of the entries of a supernode, whose remaining cost this is in small ones.
constexpr double multiplications_per_step = 256;
constexpr double entries_per_step = 16;

/// Calls poll, unless the BLAS is held exclusively: a listener may wait for a thread that waits for the BLAS.
void listen(double steps) {
  if (BlasThreads::serves_many()) poll(1 + static_cast<std::size_t>(steps));
}

template <class Scalar, class Number>
Scalar part_of(const Number& value) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return std::real(value);
  } else {
    return value;
  }
}

/// Frees the memory too.
void give_up(LargeVector<double>& values) { LargeVector<double>().swap(values); }

}  // namespace

void SupernodalFactor::analyze(const HermitianMatrix& matrix, const Adjacency& graph, SupernodalStructure structure,
                               const std::vector<char>& is_real) {
  count_analysis();
  symbolic_ = SymbolicFactor::of(matrix, graph, std::move(structure));
  has_real_unknowns_.assign(symbolic_.n_supernodes(), 0);
  for (int k = 0; k < symbolic_.n_supernodes() && !is_real.empty(); ++k) {
    has_real_unknowns_[k] = is_real[symbolic_.order()[symbolic_.first_column(k)]];
  }
  below_.resize(static_cast<Eigen::Index>(symbolic_.n_rows()));
}

double SupernodalFactor::multiplications() const {
  double sum = 0;
  for (int k = 0; k < symbolic_.n_supernodes(); ++k) {
    double of_real = 0;
    for (int column = 0; column < symbolic_.columns(k); ++column) {
      const double below = symbolic_.rows(k) - column;
      of_real += below * (below + 1) / 2;
    }
    sum += is_real_[k] ? of_real : 4 * of_real;
  }
  return sum;
}

double SupernodalFactor::n_doubles(const SymbolicFactor::Path& path) const {
  double sum = 0;
  for (const int k : path.supernodes()) sum += static_cast<double>(offset_[k + 1] - offset_[k]);
  return sum;
}

bool SupernodalFactor::factorize(const HermitianMatrix& matrix) {
  const int n_super = symbolic_.n_supernodes();
  listen(static_cast<double>(matrix.nonZeros()));
  is_real_.assign(n_super, 1);
  offset_.assign(n_super + 1, 0);
  for (int k = 0; k < n_super; ++k) {
    const auto entries = symbolic_.entries(k);
    if (has_real_unknowns_[k]) is_real_[k] = 1;
    is_real_[k] = is_real_[k] != 0 && std::all_of(entries.begin(), entries.end(), [&](const auto& entry) {
                    return matrix.valuePtr()[entry.source < 0 ? ~entry.source : entry.source].imag() == 0;
                  });
    if (!is_real_[k] && symbolic_.parent(k) >= 0) is_real_[symbolic_.parent(k)] = 0;
    const auto n_entries = static_cast<std::ptrdiff_t>(symbolic_.rows(k)) * symbolic_.columns(k);
    offset_[k + 1] = offset_[k] + n_entries * (is_real_[k] ? 1 : 2);
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
  symbolic_.schedule().run_up(
      n_threads(symbolic_.schedule().cost() / multiplications_per_step),
      [&](int k) {
        if (!is_definite) return;
        const bool done = is_real_[k] ? eliminate<double>(k, matrix) : eliminate<Complex>(k, matrix);
        if (!done) is_definite = false;
      },
      // A caller with a listener leaves longer fronts, of 50 ms, to another thread.
      2e8);
  passed_.clear();
  return is_definite;
}

unsigned SupernodalFactor::n_threads(double steps) const {
  if (!BlasThreads::serves_many()) return 1;
  if (max_threads_ > 0) return max_threads_;
  return max_threads_for(steps);
}

template <class Scalar>
bool SupernodalFactor::eliminate(int k, const HermitianMatrix& matrix) {
  const DenseBlock<Scalar> own = block<Scalar>(k);
  const double width = own.width;
  const double below = own.below();
  std::fill(own.values, own.column(own.width), Scalar(0));
  for (const auto [source, target] : symbolic_.entries(k)) {
    const Complex value = source < 0 ? std::conj(matrix.valuePtr()[~source]) : matrix.valuePtr()[source];
    own.values[target] = part_of<Scalar>(value);
  }
  for_each_child<Scalar>(k, [&](int child, const auto* from) { add_to_columns(child, from, own); });
  const std::size_t doubles = std::is_same_v<Scalar, double> ? 1 : 2;
  const auto worked = [&](double multiplications) {
    listen(static_cast<double>(doubles * doubles) * multiplications / multiplications_per_step);
  };
  listen(width * own.height / entries_per_step);
  if (!eliminate_columns(own)) return false;
  if (below == 0) {
    for (const int child : symbolic_.children(k)) give_up(passed_[child]);
    return true;
  }
  worked(width * width * width / 3);
  divide_below(own);
  worked(below * width * width);
  passed_[k].resize(static_cast<std::size_t>(own.below()) * static_cast<std::size_t>(own.below()) * doubles);
  auto* const passed = reinterpret_cast<Scalar*>(passed_[k].data());
  multiply_below(own, passed);
  worked(0.5 * below * below * width);
  for_each_child<Scalar>(k, [&](int child, const auto* from) {
    add_below(child, from, own, passed);
    give_up(passed_[child]);
  });
  listen(below * below / entries_per_step);
  return true;
}

/// Calls visit(child, block that it passes on).
template <class Scalar, class Visit>
void SupernodalFactor::for_each_child(int k, const Visit& visit) {
  for (const int child : symbolic_.children(k)) {
    const double* const from = passed_[child].data();
    if (is_real_[child]) {
      visit(child, from);
    } else {
      visit(child, reinterpret_cast<const Complex*>(from));
    }
  }
}

/// Adds to the columns of the parent.
template <class Scalar, class OfChild>
void SupernodalFactor::add_to_columns(int child, const OfChild* from, const DenseBlock<Scalar>& own) const {
  const int* const index = symbolic_.index_in_parent(child) + symbolic_.columns(child);
  const int n = symbolic_.rows(child) - symbolic_.columns(child);
  for (int j = 0; j < n && index[j] < own.width; ++j) {
    const OfChild* const column = from + static_cast<std::ptrdiff_t>(j) * n;
    Scalar* const target = own.column(index[j]);
    for (int i = j; i < n; ++i) target[index[i]] += part_of<Scalar>(column[i]);
  }
}

/// Adds to the block that the parent passes on.
template <class Scalar, class OfChild>
void SupernodalFactor::add_below(int child, const OfChild* from, const DenseBlock<Scalar>& own, Scalar* passed) const {
  const int* const index = symbolic_.index_in_parent(child) + symbolic_.columns(child);
  const int n = symbolic_.rows(child) - symbolic_.columns(child);
  const int width = own.width;
  const int first = static_cast<int>(std::lower_bound(index, index + n, width) - index);
  for (int j = first; j < n; ++j) {
    const OfChild* const column = from + static_cast<std::ptrdiff_t>(j) * n;
    Scalar* const target = passed + static_cast<std::ptrdiff_t>(index[j] - width) * own.below();
    for (int i = j; i < n; ++i) target[index[i] - width] += part_of<Scalar>(column[i]);
  }
}

void SupernodalFactor::forward(const SymbolicFactor::Path& path, ComplexVector& work) {
  count_solve(n_doubles(path));
  path.schedule().run_up(n_threads(path.schedule().cost() / entries_per_step), [&](int member) {
    const int k = path.supernodes()[member];
    const int width = symbolic_.columns(k);
    const int height = symbolic_.rows(k);
    listen(width * height / entries_per_step);
    Complex* const own = work.data() + symbolic_.first_column(k);
    Complex* const passed = below_.data() + symbolic_.first_row(k) + width;
    std::fill(passed, passed + (height - width), Complex(0));
    for (const int child : symbolic_.children(k)) {
      if (!path.contains(child)) continue;
      const Complex* const from = below_.data() + symbolic_.first_row(child);
      const int* const index = symbolic_.index_in_parent(child);
      int row = symbolic_.columns(child);
      for (; row < symbolic_.rows(child) && index[row] < width; ++row) own[index[row]] += from[row];
      for (; row < symbolic_.rows(child); ++row) passed[index[row] - width] += from[row];
    }
    // Real unknowns get only the real part of what complex ones pass on.
    if (has_real_unknowns_[k]) std::for_each(own, own + width, [](Complex& value) { value.imag(0); });
    if (is_real_[k]) {
      solve_lower(block<double>(k), own, passed);
    } else {
      solve_lower(block<Complex>(k), own, passed);
    }
  });
}

void SupernodalFactor::backward(const SymbolicFactor::Path& path, ComplexVector& work) {
  count_solve(n_doubles(path));
  path.schedule().run_down(n_threads(path.schedule().cost() / entries_per_step), [&](int member) {
    const int k = path.supernodes()[member];
    const int width = symbolic_.columns(k);
    const int below = symbolic_.rows(k) - width;
    listen(width * (width + below) / entries_per_step);
    Complex* const own = work.data() + symbolic_.first_column(k);
    Complex* const above = below_.data() + symbolic_.first_row(k) + width;
    for (int i = 0; i < below; ++i) above[i] = work[symbolic_.row_indices(k)[width + i]];
    if (is_real_[k]) {
      solve_upper(block<double>(k), own, above);
    } else {
      solve_upper(block<Complex>(k), own, above);
    }
  });
}

}  // namespace spectral_conformal

#endif
