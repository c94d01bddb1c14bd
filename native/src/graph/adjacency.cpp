#include "graph/adjacency.h"

namespace spectral_conformal {

Adjacency::Adjacency(int n_nodes, const std::vector<std::array<int, 2>>& edges)
    : Adjacency(from_arcs(n_nodes, [&](auto&& visit) {
        for (std::size_t e = 0; e < edges.size(); ++e) {
          const auto [a, b] = edges[e];
          visit(a, static_cast<int>(e), b);
          visit(b, static_cast<int>(e), a);
        }
      })) {}

Adjacency graph_of(const HermitianMatrix& matrix) {
  return Adjacency::from_arcs(static_cast<int>(matrix.rows()), [&](const auto& visit) {
    for (int column = 0; column < matrix.cols(); ++column) {
      for (int e = matrix.outerIndexPtr()[column]; e < matrix.outerIndexPtr()[column + 1]; ++e) {
        const int row = matrix.innerIndexPtr()[e];
        if (row == column) continue;
        visit(row, e, column);
        visit(column, e, row);
      }
    }
  });
}

}  // namespace spectral_conformal
