#pragma once

#include <cstdlib>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "graph/adjacency.h"

namespace spectral_conformal {

/// Dijkstra's algorithm, driven by its caller, who knows the arcs and their lengths: `offer` the sources at distance 0,
/// then `settle` node after node and offer every node that an arc leads to.
///
///     for (int node = search.settle(); node >= 0; node = search.settle())
///       for (each arc from node) search.offer(to, search.distance(node) + length, node);
///
/// Of nodes at the same distance the one with the smaller number is settled first, and of paths of the same length the
/// one that was offered first stays. Lengths must not be negative. Not boost::dijkstra_shortest_paths: paths with costs
/// for turns go over arcs instead of nodes, end at the first target, and ask which arcs are allowed only where that
/// matters, for each of which Boost wants a graph model or a visitor that throws.
class ShortestPathSearch {
 public:
  explicit ShortestPathSearch(int n_nodes);
  /// Whether a path of this length is shorter than all that were offered.
  bool improves(int node, double path) const { return path < distance(node); }
  /// Takes a path to a node if it is shorter than all before. `previous`: what its last step comes from or along, the
  /// caller's number for it; -1 at a source.
  void offer(int node, double distance, int previous = -1);
  /// The nearest node whose distance became final by this call, or -1 where no other can be reached.
  int settle();
  /// Of the shortest path that was offered; infinite where there is none.
  double distance(int node) const {
    return reached_[node].by == unreached ? std::numeric_limits<double>::infinity() : reached_[node].distance;
  }
  int previous(int node) const { return reached_[node].by == unreached ? -1 : reached_[node].by - 2; }
  /// (n_nodes,) each, of all nodes.
  std::vector<double> distances() const;
  std::vector<int> previous() const;

 private:
  /// All 0 where a node was not reached, as the system hands memory out: what a search that ends early does not come to
  /// is never touched.
  struct Reached {
    double distance;
    int by;  ///< `previous` + 2, which is at least 1
  };
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  static constexpr int unreached = 0;

  int n_nodes_;
  std::unique_ptr<Reached[], Free> reached_;
  std::vector<std::pair<double, int>> heap_;  ///< smallest first; entries of nodes that came nearer since are skipped
};

/// For every node the least number of arcs from a source, -1 where there is no path (breadth-first search).
std::vector<int> steps_from(const Adjacency& graph, const std::vector<int>& sources);

}  // namespace spectral_conformal
