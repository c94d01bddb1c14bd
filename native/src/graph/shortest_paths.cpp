#include "graph/shortest_paths.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>

namespace spectral_conformal {

ShortestPathSearch::ShortestPathSearch(int n_nodes)
    : distance_(static_cast<std::size_t>(n_nodes), std::numeric_limits<double>::infinity()),
      previous_(static_cast<std::size_t>(n_nodes), -1) {}

void ShortestPathSearch::offer(int node, double distance, int previous) {
  if (!improves(node, distance)) return;
  distance_[node] = distance;
  previous_[node] = previous;
  heap_.emplace_back(distance, node);
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

int ShortestPathSearch::settle() {
  while (!heap_.empty()) {
    const auto [distance, node] = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.pop_back();
    if (distance == distance_[node]) return node;
  }
  return -1;
}

std::vector<int> steps_from(const Adjacency& graph, const std::vector<int>& sources) {
  std::vector<int> steps(static_cast<std::size_t>(graph.n_nodes()), -1);
  std::vector<int> reached(sources);
  for (const int node : sources) steps[node] = 0;
  for (std::size_t head = 0; head < reached.size(); ++head) {
    const int node = reached[head];
    for (const auto& arc : graph.arcs(node)) {
      if (steps[arc.to] >= 0) continue;
      steps[arc.to] = steps[node] + 1;
      reached.push_back(arc.to);
    }
  }
  return steps;
}

}  // namespace spectral_conformal
