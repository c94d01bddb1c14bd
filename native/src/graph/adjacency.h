#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "graph/grouped.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

constexpr int no_index = -1;  ///< of no node

/// The edge between two nodes, the smaller first.
inline std::array<int, 2> edge_between(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The arcs of a graph on the nodes 0, 1, ..., n - 1, grouped by source node. The arcs of a node keep their input
/// order.
class Adjacency {
 public:
  /// An edge as seen from a node that it leaves.
  struct Arc {
    int edge;
    int to;
  };

  Adjacency() = default;
  /// An undirected graph with edges (E, 2): edge e yields an arc in either direction, both numbered e.
  Adjacency(int n_nodes, const std::vector<std::array<int, 2>>& edges);
  /// `for_each_arc(visit)` calls visit(from, edge, to) for every arc. It is called twice and must visit the same arcs
  /// in the same order.
  template <class ForEachArc>
  static Adjacency from_arcs(int n_nodes, const ForEachArc& for_each_arc);

  int n_nodes() const { return arcs_.n_keys(); }
  int n_arcs() const { return static_cast<int>(arcs_.values().size()); }
  /// The arcs [first_arc(node), first_arc(node + 1)) leave the node.
  int first_arc(int node) const { return arcs_.first(node); }
  const Arc& arc(int index) const { return arcs_.values()[index]; }
  Grouped<Arc>::Range<const Arc*> arcs(int node) const { return arcs_[node]; }

 private:
  Grouped<Arc> arcs_;
};

template <class ForEachArc>
Adjacency Adjacency::from_arcs(int n_nodes, const ForEachArc& for_each_arc) {
  Adjacency graph;
  graph.arcs_ = Grouped<Arc>(n_nodes, [&](const auto& visit) {
    for_each_arc([&](int from, int edge, int to) { visit(from, Arc{edge, to}); });
  });
  return graph;
}

/// The graph of a matrix pattern (compressed, lower triangle): one edge per entry below the diagonal, numbered by its
/// index among the values.
Adjacency graph_of(const HermitianMatrix& matrix);

}  // namespace spectral_conformal
