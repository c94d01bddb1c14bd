#pragma once

#include <vector>

namespace spectral_conformal {

/// An edge that carries flow up to `capacity`, finite and >= 0, in either direction.
struct CapacityEdge {
  int a;
  int b;
  double capacity;
};

/// The source's side of a minimum cut of an undirected graph, per node 1 on that side: what the source still reaches
/// when the flow to the sink is maximal, which is the smallest of the sides of all minimum cuts. `source` and `sink`
/// differ. Capacities that differ by less than 1e-12 of the largest count as equal. The flow is Boost.Graph's (Boykov
/// and Kolmogorov 2004).
std::vector<char> min_cut_source_side(int n_nodes, const std::vector<CapacityEdge>& edges, int source, int sink);

}  // namespace spectral_conformal
