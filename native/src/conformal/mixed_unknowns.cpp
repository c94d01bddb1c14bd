#include "conformal/mixed_unknowns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "graph/adjacency.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

using Expansion = LinearConstraints::Expansion;

/// The unknown along each axis that belongs to a vertex alone, or -1.
using OwnUnknowns = std::vector<std::array<int, 2>>;

OwnUnknowns own_unknowns(const LinearConstraints& constraints) {
  std::vector<int> uses(static_cast<std::size_t>(constraints.n_unknowns()));
  for (int c = 0; c < constraints.expansion().rows(); ++c) {
    for (Expansion::InnerIterator it(constraints.expansion(), c); it; ++it) ++uses[it.col()];
  }
  OwnUnknowns result(static_cast<std::size_t>(constraints.n_vertices()), {no_index, no_index});
  for (int k = 0; k < constraints.n_unknowns(); ++k) {
    const int coordinate = constraints.coordinates()[k];
    if (uses[k] == 1 && coordinate / 2 < constraints.n_vertices()) result[coordinate / 2][coordinate % 2] = k;
  }
  return result;
}

/// Whether the energy couples u and v of such unknowns. Where all of the border is constrained, it does not.
bool couples_axes(const HermitianMatrix& matrix, const OwnUnknowns& own) {
  const auto has_both = [&](int i, int j) { return own[i][0] != no_index && own[j][1] != no_index; };
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (HermitianMatrix::InnerIterator it(matrix, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      if (it.value().imag() != 0 && (has_both(i, j) || has_both(j, i))) return true;
    }
  }
  return false;
}

}  // namespace

MixedUnknowns mixed_unknowns(const LinearConstraints& constraints, const HermitianMatrix& matrix,
                             const Positions& positions, const Factorization& factorization) {
  const auto n_unknowns = static_cast<std::size_t>(constraints.n_unknowns());
  MixedUnknowns result;
  result.row.assign(n_unknowns, no_index);
  result.is_imaginary.assign(n_unknowns, 0);
  const OwnUnknowns own = own_unknowns(constraints);
  int n_own = 0;
  int n_free = 0;  // of vertices that have both
  for (const auto& [u, v] : own) {
    const int n = (u != no_index ? 1 : 0) + (v != no_index ? 1 : 0);
    n_own += n;
    if (n == 2) n_free += n;
  }
  // The unknowns eliminated last are one dense block. A separator of a surface has about sqrt(V) vertices; beyond four
  // times as many, the complex part saves less than the block costs (on sheets with 1 to 4 straight sides).
  constexpr double max_separators = 4;
  const auto leaves_few = [&](int n) {
    return constraints.n_unknowns() - n <= max_separators * std::sqrt(static_cast<double>(constraints.n_vertices()));
  };
  const bool is_mixed = leaves_few(n_free) && couples_axes(matrix, own);
  const auto add_real = [&](int k) {
    result.row[k] = result.size();
    result.is_real.push_back(1);
  };
  if (is_mixed || leaves_few(n_own)) {
    for (const int vertex : factorization.order(graph_of(matrix), &positions)) {
      const auto& [u, v] = own[vertex];
      if (!is_mixed) {
        if (u != no_index) add_real(u);
        if (v != no_index) add_real(v);
      } else if (u != no_index && v != no_index) {
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
