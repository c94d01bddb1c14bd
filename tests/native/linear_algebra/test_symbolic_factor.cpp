#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "linear_algebra/symbolic_factor.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

SymbolicFactor symbolic_factor(const HermitianMatrix& matrix) {
  const int n = static_cast<int>(matrix.cols());
  return SymbolicFactor::of(matrix, graph_of(matrix), structure_of(matrix, strips_first(n)));
}

}  // namespace

TEST_SUITE_BEGIN("symbolic_factor");

TEST_CASE("every entry of the matrix goes to its row and column, which the block has") {
  const HermitianMatrix matrix = shifted_energy(20);
  const SymbolicFactor symbolic = symbolic_factor(matrix);
  std::vector<int> row_of(static_cast<std::size_t>(matrix.nonZeros()));
  std::vector<int> column_of(row_of.size());
  for (int column = 0; column < matrix.cols(); ++column) {
    for (int e = matrix.outerIndexPtr()[column]; e < matrix.outerIndexPtr()[column + 1]; ++e) {
      row_of[e] = matrix.innerIndexPtr()[e];
      column_of[e] = column;
    }
  }
  std::vector<int> times(row_of.size(), 0);
  for (int k = 0; k < symbolic.n_supernodes(); ++k) {
    for (const auto [source, target] : symbolic.entries(k)) {
      const int e = source < 0 ? ~source : source;
      ++times[e];
      const int row = symbolic.order()[symbolic.row_indices(k)[target % symbolic.rows(k)]];
      const int column = symbolic.order()[symbolic.first_column(k) + target / symbolic.rows(k)];
      CHECK(row == (source < 0 ? column_of[e] : row_of[e]));
      CHECK(column == (source < 0 ? row_of[e] : column_of[e]));
    }
  }
  CHECK(times == std::vector<int>(times.size(), 1));
}

TEST_CASE("rows below the columns of a supernode are rows of its parent") {
  const HermitianMatrix matrix = shifted_energy(20);
  const SymbolicFactor symbolic = symbolic_factor(matrix);
  int n_children = 0;
  for (int k = 0; k < symbolic.n_supernodes(); ++k) {
    for (const int child : symbolic.children(k)) {
      CHECK(symbolic.parent(child) == k);
      ++n_children;
      for (int i = symbolic.columns(child); i < symbolic.rows(child); ++i) {
        CHECK(symbolic.row_indices(k)[symbolic.index_in_parent(child)[i]] == symbolic.row_indices(child)[i]);
      }
    }
    if (symbolic.parent(k) < 0) CHECK(symbolic.rows(k) == symbolic.columns(k));
  }
  CHECK(n_children > symbolic.n_supernodes() / 2);
}

TEST_CASE("a path holds all that lies above its columns") {
  const HermitianMatrix matrix = shifted_energy(25);
  const SymbolicFactor symbolic = symbolic_factor(matrix);
  const std::vector<int> columns{3, symbolic.n() / 2, symbolic.n() - 1};
  const SymbolicFactor::Path path = symbolic.above(columns);
  CHECK(path.supernodes().size() < symbolic.whole().supernodes().size());
  CHECK(std::is_sorted(path.supernodes().begin(), path.supernodes().end()));
  for (const int k : path.supernodes()) {
    CHECK(path.contains(k));
    if (symbolic.parent(k) >= 0) CHECK(path.contains(symbolic.parent(k)));
  }
  for (const int column : columns) {
    const auto holds = [&](int k) {
      return symbolic.first_column(k) <= column && column < symbolic.first_column(k) + symbolic.columns(k);
    };
    CHECK(std::any_of(path.supernodes().begin(), path.supernodes().end(), holds));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
