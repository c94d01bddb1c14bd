#include "conformal/lscm.h"

#include <cmath>
#include <limits>
#include <vector>

namespace spectral_conformal {
namespace {

/// The rows and columns of the free vertices, in their order.
HermitianMatrix free_block(const HermitianMatrix& matrix, const std::vector<int>& free_index, int n_free) {
  HermitianMatrix block(n_free, n_free);
  block.reserve(matrix.nonZeros());
  for (int column = 0; column < matrix.outerSize(); ++column) {
    if (free_index[column] < 0) continue;
    block.startVec(free_index[column]);
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
      if (free_index[it.row()] >= 0) block.insertBack(free_index[it.row()], free_index[column]) = it.value();
    }
  }
  block.finalize();
  return block;
}

}  // namespace

PinnedSolution solve_lscm(const ConformalEnergy& energy, const Pins& pins, FactorizationBackend backend,
                          const Progress& progress) {
  const HermitianMatrix& matrix = energy.matrix();
  const int n = energy.n_vertices();
  PinnedSolution result;
  result.vector = ComplexVector::Zero(n);
  std::vector<int> free_index(static_cast<std::size_t>(n), 0);
  Complex mean = 0;
  for (const auto& [vertex, position] : pins) {
    free_index[vertex] = -1;
    mean += position / static_cast<double>(pins.size());
  }
  int n_free = 0;
  for (int& index : free_index) index = index < 0 ? -1 : n_free++;
  // Starting from the pins' mean keeps the numbers small wherever the pins are: L 1 = 0.
  result.vector.setConstant(mean);
  double extent = 0;
  for (const auto& [vertex, position] : pins) {
    result.vector[vertex] = position;
    extent = std::max(extent, std::abs(position - mean));
  }
  if (n_free == 0) return result;

  report(progress, 0.1, "factorization");
  const HermitianMatrix block = free_block(matrix, free_index, n_free);
  const auto factorization = make_factorization(backend, n_free);
  factorization->analyze(block);
  if (!factorization->factorize(block)) {
    result.is_factorized = false;
    return result;
  }
  report(progress, 0.8, "solve");
  constexpr int max_solves = 4;  // the first and its refinements, which end by themselves where rounding is reached
  ComplexVector gradient;
  ComplexVector rhs(n_free);
  ComplexVector step(n_free);
  double previous = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_solves; ++k) {
    energy.apply(result.vector, gradient);
    for (int v = 0; v < n; ++v) {
      if (free_index[v] >= 0) rhs[free_index[v]] = gradient[v];
    }
    const double norm = rhs.norm();
    if (!(norm < 0.5 * previous)) break;  // rounding is reached
    previous = norm;
    factorization->solve(rhs, step);
    for (int v = 0; v < n; ++v) {
      if (free_index[v] >= 0) result.vector[v] -= step[free_index[v]];
    }
  }
  energy.apply(result.vector, gradient);
  double largest_diagonal = 0;
  double square = 0;
  for (int v = 0; v < n; ++v) {
    if (free_index[v] < 0) continue;
    square += std::norm(gradient[v]);
    largest_diagonal = std::max(largest_diagonal, matrix.valuePtr()[matrix.outerIndexPtr()[v]].real());
    extent = std::max(extent, std::abs(result.vector[v] - mean));
  }
  result.residual = extent > 0 && largest_diagonal > 0 ? std::sqrt(square) / (largest_diagonal * extent) : 0;
  return result;
}

}  // namespace spectral_conformal
