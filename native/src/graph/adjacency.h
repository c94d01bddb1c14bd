#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The arcs of a graph on the nodes 0, 1, ..., n - 1, grouped by the node that they leave (compressed sparse rows). The
/// arcs of a node keep the order in which they were given.
class Adjacency {
 public:
  /// An edge as it leaves a node.
  struct Arc {
    int edge;
    int to;
  };
  struct ArcRange {
    const Arc* first;
    const Arc* last;
    const Arc* begin() const { return first; }
    const Arc* end() const { return last; }
  };

  Adjacency() = default;
  /// An undirected graph: edge e (E, 2) gives an arc in either direction, both with the number e.
  Adjacency(int n_nodes, const std::vector<std::array<int, 2>>& edges);
  /// `for_each_arc(visit)` calls visit(from, edge, to) for every arc. It is called twice and must visit alike.
  template <class ForEachArc>
  static Adjacency from_arcs(int n_nodes, const ForEachArc& for_each_arc);

  int n_nodes() const { return static_cast<int>(start_.size()) - 1; }
  int n_arcs() const { return static_cast<int>(arcs_.size()); }
  /// The arcs [first_arc(node), first_arc(node + 1)) leave the node.
  int first_arc(int node) const { return start_[node]; }
  const Arc& arc(int index) const { return arcs_[index]; }
  ArcRange arcs(int node) const { return {arcs_.data() + start_[node], arcs_.data() + start_[node + 1]}; }

 private:
  std::vector<int> start_{0};
  std::vector<Arc> arcs_;
};

template <class ForEachArc>
Adjacency Adjacency::from_arcs(int n_nodes, const ForEachArc& for_each_arc) {
  Adjacency graph;
  graph.start_.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
  for_each_arc([&](int from, int, int) { ++graph.start_[from + 1]; });
  for (std::size_t i = 1; i < graph.start_.size(); ++i) graph.start_[i] += graph.start_[i - 1];
  graph.arcs_.resize(static_cast<std::size_t>(graph.start_.back()));
  std::vector<int> fill(graph.start_.begin(), graph.start_.end() - 1);
  for_each_arc([&](int from, int edge, int to) { graph.arcs_[fill[from]++] = {edge, to}; });
  return graph;
}

/// The graph of a matrix's pattern (compressed, the lower triangle): an edge for every entry below the diagonal, with
/// its index among the values as its number.
Adjacency graph_of(const HermitianMatrix& matrix);

}  // namespace spectral_conformal
