#pragma once

#include <cstdlib>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "graph/adjacency.h"

namespace spectral_conformal {

/// Dijkstra's algorithm, driven by its caller, who knows the arcs and their lengths: `offer` the sources at distance 0,
/// then `settle` one node after another and offer the target of each of its arcs.
///
///     for (int node = search.settle(); node >= 0; node = search.settle())
///       for (each arc from node) search.offer(to, search.distance(node) + length, node);
///
/// Ties: the node with the smaller number is settled first; the path offered first stays. Lengths must be nonnegative.
/// Not boost::dijkstra_shortest_paths: our paths with turn costs run over arcs instead of nodes, end at the first
/// target, and test lazily which arcs are allowed; each of these would need a graph model or a throwing visitor in
/// Boost.
class ShortestPathSearch {
 public:
  explicit ShortestPathSearch(int n_nodes);
  /// Whether a path of this length is shorter than all offered so far.
  bool improves(int node, double path) const { return path < distance(node); }
  /// Takes a path to a node if it is shorter than all before. `previous`: the caller's number for the origin of its
  /// last step, or for the arc along it; -1 at a source.
  void offer(int node, double distance, int previous = -1);
  /// Settles the nearest open node and returns it; -1 if no other node can be reached.
  int settle();
  /// The length of the shortest path offered; infinite if there is none.
  double distance(int node) const { return is_reached(node) ? distance_[node] : infinity; }
  int previous(int node) const { return is_reached(node) ? by_[node] - 2 : -1; }
  /// (n_nodes,) each, of all nodes.
  std::vector<double> distances() const;
  std::vector<int> previous() const;

 private:
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  bool is_reached(int node) const { return by_[node] != 0; }

  int n_nodes_;
  /// `previous` + 2, which is at least 1; 0 for a node not reached, as in fresh memory from the system: a search that
  /// ends early never touches the rest.
  std::unique_ptr<int[], Free> by_;
  std::unique_ptr<double[], Free> distance_;  ///< of the nodes reached; otherwise not set
  std::vector<std::pair<double, int>> heap_;  ///< smallest first; outdated entries are skipped
};

/// For every node the least number of arcs from a source, -1 if there is no path (breadth-first search).
std::vector<int> steps_from(const Adjacency& graph, const std::vector<int>& sources);

}  // namespace spectral_conformal
