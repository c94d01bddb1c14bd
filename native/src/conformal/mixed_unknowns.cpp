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

/// Forgets the unknowns of vertices whose coordinates are not both free, or which others depend on.
void keep_free(const LinearConstraints& constraints, std::vector<std::array<int, 2>>& unknowns) {
  const auto forget = [&](int vertex) {
    if (vertex < constraints.n_vertices()) unknowns[vertex] = {no_index, no_index};
  };
  for (int c = 0; c < constraints.expansion().rows(); ++c) {
    bool is_free = false;
    for (Expansion::InnerIterator it(constraints.expansion(), c); it; ++it) {
      const int coordinate = constraints.coordinates()[it.col()];
      is_free = coordinate == c;
      if (!is_free) forget(coordinate / 2);
    }
    if (!is_free) forget(c / 2);
  }
}

}  // namespace

MixedUnknowns mixed_unknowns(const LinearConstraints& constraints, const HermitianMatrix& matrix,
                             const Positions& positions, const Factorization& factorization) {
  const auto n_unknowns = static_cast<std::size_t>(constraints.n_unknowns());
  MixedUnknowns result;
  result.row.assign(n_unknowns, no_index);
  result.is_imaginary.assign(n_unknowns, 0);
  std::vector<std::array<int, 2>> free = unknowns_of_vertices(constraints);
  keep_free(constraints, free);
  const auto n_free = std::count_if(free.begin(), free.end(), [](const auto& of) { return of[0] != no_index; });
  const auto n_real = static_cast<double>(n_unknowns) - 2.0 * static_cast<double>(n_free);
  // The real unknowns are one dense block at the end. A separator of a surface has about the root of its vertices; from
  // four times as many on, the complex part saves less than the block costs (sheets with 1 to 4 straight sides).
  constexpr double most_separators = 4;
  if (n_real <= most_separators * std::sqrt(static_cast<double>(constraints.n_vertices()))) {
    for (const int vertex : factorization.order(graph_of(matrix), &positions)) {
      const auto& [u, v] = free[vertex];
      if (u == no_index) continue;
      result.row[u] = result.row[v] = result.size();
      result.is_imaginary[v] = 1;
      result.is_real.push_back(0);
    }
  }
  result.is_mixed = result.size() > 0;
  for (int& row : result.row) {
    if (row != no_index) continue;
    row = result.size();
    result.is_real.push_back(1);
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
          if (unknowns.is_imaginary[k]) continue;  // of the same row as its real part
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
          // Inside the patch u and v are not coupled, and so is their factor.
          if (value == 0.0) continue;
          // An entry off the diagonal stands for its mirror image as well.
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
