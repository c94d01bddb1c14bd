#include "linear_algebra/distance_numbering.h"

#include <algorithm>
#include <cstddef>

#include "graph/adjacency.h"

namespace spectral_conformal {
namespace {

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

/// Connected nodes by their distance from one of them.
class BreadthFirst {
 public:
  explicit BreadthFirst(const Adjacency& graph)
      : graph_(graph), search_(static_cast<std::size_t>(graph.n_nodes()), 0) {}

  bool was_reached(int node) const { return search_[static_cast<std::size_t>(node)] > 0; }
  const std::vector<int>& from(int start) {
    ++n_searches_;
    reached_.clear();
    reach(start);
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      for (const Adjacency::Arc arc : graph_.arcs(reached_[i])) {
        if (search_[static_cast<std::size_t>(arc.to)] != n_searches_) reach(arc.to);
      }
    }
    return reached_;
  }

 private:
  void reach(int node) {
    search_[static_cast<std::size_t>(node)] = n_searches_;
    reached_.push_back(node);
  }

  const Adjacency& graph_;
  std::vector<int> search_;  ///< the last one that reached each node
  int n_searches_ = 0;
  std::vector<int> reached_;
};

}  // namespace

std::vector<int> numbering_by_distance(const HermitianMatrix& matrix) {
  const Adjacency graph = graph_of(matrix);
  BreadthFirst search(graph);
  std::vector<int> numbering;
  numbering.reserve(static_cast<std::size_t>(graph.n_nodes()));
  for (int node = 0; node < graph.n_nodes(); ++node) {
    if (search.was_reached(node)) continue;
    const int end = search.from(node).back();
    const std::vector<int>& reached = search.from(end);
    numbering.insert(numbering.end(), reached.rbegin(), reached.rend());
  }
  return numbering;
}

}  // namespace spectral_conformal
