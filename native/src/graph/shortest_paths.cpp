#include "graph/shortest_paths.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <new>

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {

ShortestPathSearch::ShortestPathSearch(int n_nodes)
    : n_nodes_(n_nodes),
      by_(static_cast<int*>(std::calloc(std::max<std::size_t>(n_nodes, 1), sizeof(int)))),
      distance_(static_cast<double*>(std::malloc(std::max<std::size_t>(n_nodes, 1) * sizeof(double)))) {
  if (!by_ || !distance_) throw std::bad_alloc();
}

void ShortestPathSearch::offer(int node, double distance, int previous) {
  if (!improves(node, distance)) return;
  distance_[node] = distance;
  by_[node] = previous + 2;
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

std::vector<double> ShortestPathSearch::distances() const {
  std::vector<double> result(static_cast<std::size_t>(n_nodes_));
  for (int node = 0; node < n_nodes_; ++node) result[static_cast<std::size_t>(node)] = distance(node);
  return result;
}

std::vector<int> ShortestPathSearch::previous() const {
  std::vector<int> result(static_cast<std::size_t>(n_nodes_));
  for (int node = 0; node < n_nodes_; ++node) result[static_cast<std::size_t>(node)] = previous(node);
  return result;
}

std::vector<int> steps_from(const Adjacency& graph, const std::vector<int>& sources) {
  std::vector<int> steps(static_cast<std::size_t>(graph.n_nodes()), -1);
  std::vector<int> reached(sources);
  for (const int node : sources) steps[node] = 0;
  for (std::size_t head = 0; head < reached.size(); ++head) {
    const int node = reached[head];
    poll();
    for (const auto& arc : graph.arcs(node)) {
      if (steps[arc.to] >= 0) continue;
      steps[arc.to] = steps[node] + 1;
      reached.push_back(arc.to);
    }
  }
  return steps;
}

}  // namespace spectral_conformal
