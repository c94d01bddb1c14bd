#include "graph/adjacency.h"

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {
Adjacency::Adjacency(int n_nodes, const std::vector<std::array<int, 2>>& edges)
    : Adjacency(from_arcs(n_nodes, [&](auto&& visit) {
        for_each_polled(edges.size(), [&](std::size_t e) {
          const auto [a, b] = edges[e];
          visit(a, static_cast<int>(e), b);
          visit(b, static_cast<int>(e), a);
        });
      })) {}

Adjacency graph_of(const HermitianMatrix& matrix) {
  return Adjacency::from_arcs(static_cast<int>(matrix.rows()), [&](const auto& visit) {
    for_each_polled(matrix.cols(), [&](Eigen::Index i) {
      const auto column = static_cast<int>(i);
      for (int e = matrix.outerIndexPtr()[column]; e < matrix.outerIndexPtr()[column + 1]; ++e) {
        const int row = matrix.innerIndexPtr()[e];
        if (row == column) continue;
        visit(row, e, column);
        visit(column, e, row);
      }
    });
  });
}

}  // namespace spectral_conformal
