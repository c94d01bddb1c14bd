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

}  // namespace spectral_conformal
