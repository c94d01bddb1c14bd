#include "conformal/mixed_unknowns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "graph/adjacency.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

using Expansion = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The unknown of each vertex along each axis, or -1.
std::vector<std::array<int, 2>> unknowns_of_vertices(const LinearConstraints& constraints) {
  std::vector<std::array<int, 2>> result(static_cast<std::size_t>(constraints.n_vertices()), {no_index, no_index});
  for (int k = 0; k < constraints.n_unknowns(); ++k) {
    const int coordinate = constraints.coordinates()[k];
    if (coordinate / 2 < constraints.n_vertices()) result[coordinate / 2][coordinate % 2] = k;
  }
  return result;
}

/// (n_unknowns,) whether an unknown is part of only one coordinate.
std::vector<char> of_one_coordinate(const LinearConstraints& constraints) {
  std::vector<int> uses(static_cast<std::size_t>(constraints.n_unknowns()));
  for (int c = 0; c < constraints.expansion().rows(); ++c) {
    for (Expansion::InnerIterator it(constraints.expansion(), c); it; ++it) ++uses[it.col()];
  }
  std::vector<char> result(uses.size());
  std::transform(uses.begin(), uses.end(), result.begin(), [](int n) { return n == 1; });
  return result;
}

}  // namespace

MixedUnknowns mixed_unknowns(const LinearConstraints& constraints, const HermitianMatrix& matrix,
                             const Positions& positions, const Factorization& factorization) {
  const auto n_unknowns = static_cast<std::size_t>(constraints.n_unknowns());
  MixedUnknowns result;
  result.row.assign(n_unknowns, no_index);
  result.is_imaginary.assign(n_unknowns, 0);
  const std::vector<std::array<int, 2>> unknowns = unknowns_of_vertices(constraints);
  const std::vector<char> is_own = of_one_coordinate(constraints);
  const auto is_own_unknown = [&](int k) { return k != no_index && is_own[k]; };
  const auto is_free = [&](int v) { return is_own_unknown(unknowns[v][0]) && is_own_unknown(unknowns[v][1]); };
  // The unknowns eliminated last are one dense block. A separator of a surface has about sqrt(V) vertices; beyond four
  // times as many, the complex part saves less than the block costs (on sheets with 1 to 4 straight sides).
  constexpr double most_separators = 4;
  const auto is_few = [&](std::ptrdiff_t n) {
    return static_cast<double>(n) <= most_separators * std::sqrt(static_cast<double>(constraints.n_vertices()));
  };
  std::ptrdiff_t n_constrained = static_cast<std::ptrdiff_t>(n_unknowns);
  for (int v = 0; v < constraints.n_vertices(); ++v) n_constrained -= is_free(v) ? 2 : 0;
  // If the whole border is constrained, u and v are two real problems.
  const auto couples = [&](int i, int j) { return is_own_unknown(unknowns[i][0]) && is_own_unknown(unknowns[j][1]); };
  bool is_coupled = false;
  for (int j = 0; j < matrix.outerSize() && !is_coupled; ++j) {
    for (HermitianMatrix::InnerIterator it(matrix, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      if (it.value().imag() != 0 && (couples(i, j) || couples(j, i))) is_coupled = true;
    }
  }
  const bool is_mixed = is_coupled && is_few(n_constrained);
  const auto add_real = [&](int k) {
    result.row[k] = result.size();
    result.is_real.push_back(1);
  };
  if (is_mixed || is_few(std::count(is_own.begin(), is_own.end(), 0))) {
    for (const int vertex : factorization.order(graph_of(matrix), &positions)) {
      const auto& [u, v] = unknowns[vertex];
      if (!is_mixed) {
        if (is_own_unknown(u)) add_real(u);
        if (is_own_unknown(v)) add_real(v);
      } else if (is_free(vertex)) {
        result.row[u] = result.row[v] = result.size();
        result.is_imaginary[v] = 1;
        result.is_real.push_back(0);
      }
    }
  }
  result.is_ordered = result.size() > 0;
  for (std::size_t k = 0; k < n_unknowns; ++k) {
    if (result.row[k] == no_index) add_real(static_cast<int>(k));
  }
  return result;
}

HermitianMatrix mixed_matrix(const HermitianMatrix& matrix, const LinearConstraints& constraints,
                             const MixedUnknowns& unknowns) {
  struct Term {
    int row;
    Complex factor;
  };
  const Grouped<Term> terms(constraints.n_vertices(), [&](const auto& visit) {
    for (int v = 0; v < constraints.n_vertices(); ++v) {
      for (const int axis : {0, 1}) {
        for (Expansion::InnerIterator it(constraints.expansion(), 2 * v + axis); it; ++it) {
          const auto k = static_cast<std::size_t>(it.col());
          if (unknowns.is_imaginary[k]) continue;  // in the same row as its real part
          visit(v, Term{unknowns.row[k], axis == 0 ? Complex(it.value()) : Complex(0, it.value())});
        }
      }
    }
  });
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(static_cast<std::size_t>(2 * matrix.nonZeros()));
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (HermitianMatrix::InnerIterator it(matrix, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      for (const auto& [row, factor] : terms[i]) {
        for (const auto& [column, other] : terms[j]) {
          if (i == j && row < column) continue;
          Complex value = std::conj(factor) * it.value() * other;
          if (unknowns.is_real[row] && unknowns.is_real[column]) value.imag(0);
          // Inside the patch, u and v are not coupled; without the zeros, their factors are not, either.
          if (value == 0.0) continue;
          // An off-diagonal entry also stands for its conjugate across the diagonal.
          if (row == column && i != j) value = 2 * value.real();
          if (row >= column) {
            entries.emplace_back(row, column, value);
          } else {
            entries.emplace_back(column, row, std::conj(value));
          }
        }
      }
    }
  }
  return lower_triangle(unknowns.size(), entries);
}

}  // namespace spectral_conformal
