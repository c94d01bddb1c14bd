#pragma once

#include <vector>

namespace spectral_conformal {

/// An edge that carries flow up to `capacity`, finite and >= 0, in either direction.
struct CapacityEdge {
  int a;
  int b;
  double capacity;
};

/// The source side of a minimum cut of an undirected graph: 1 for nodes on that side. It consists of the nodes that the
/// source reaches in the residual network of a maximum flow, and is the smallest source side of all minimum cuts.
/// `source` and `sink` differ. Capacities that differ by less than 1e-12 of the largest count as equal. The flow is
/// computed by Boost.Graph (Boykov and Kolmogorov 2004). Throws Cancelled.
std::vector<char> min_cut_source_side(int n_nodes, const std::vector<CapacityEdge>& edges, int source, int sink);

}  // namespace spectral_conformal
