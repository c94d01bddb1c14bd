#include "mesh/boundary_loops.h"

#include <algorithm>
#include <array>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "graph/adjacency.h"
#include "graph/shortest_paths.h"

namespace spectral_conformal {

double loop_length(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions) {
  double length = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    length += (positions.row(loop[(i + 1) % loop.size()]) - positions.row(loop[i])).norm();
  }
  return length;
}

int outer_loop(const std::vector<BoundaryLoop>& loops, const Eigen::Ref<const Positions>& positions) {
  int longest = 0;
  double longest_length = -1;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const double length = loop_length(loops[i], positions);
    if (length > longest_length) {
      longest = static_cast<int>(i);
      longest_length = length;
    }
  }
  return longest;
}

namespace {

std::vector<double> distances_from(int source, const Adjacency& graph, const Eigen::Ref<const Positions>& positions) {
  ShortestPathSearch search(graph.n_nodes());
  search.offer(source, 0);
  for (int vertex = search.settle(); vertex >= 0; vertex = search.settle()) {
    poll();
    for (const auto& arc : graph.arcs(vertex)) {
      search.offer(arc.to, search.distance(vertex) + (positions.row(arc.to) - positions.row(vertex)).norm());
    }
  }
  return search.distances();
}

}  // namespace

std::array<int, 2> farthest_boundary_vertices(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions,
                                              const HermitianMatrix& neighbors) {
  const Adjacency graph = graph_of(neighbors);
  std::array<int, 2> pair{loop.front(), loop.front()};
  double farthest = -1;
  int source = loop.front();
  // Two sweeps are exact on a tree; more can only lengthen the path.
  while (true) {
    const std::vector<double> distance = distances_from(source, graph, positions);
    const int target =
        *std::max_element(loop.begin(), loop.end(), [&](int a, int b) { return distance[a] < distance[b]; });
    if (distance[target] <= farthest * (1 + sum_rounding)) break;
    farthest = distance[target];
    pair = {source, target};
    source = target;
  }
  return pair;
}

}  // namespace spectral_conformal
