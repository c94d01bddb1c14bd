#include "mesh/boundary_loops.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <queue>

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

/// Both directions of every edge of the matrix's pattern.
struct EdgeGraph {
  std::vector<int> start;
  std::vector<int> neighbour;

  explicit EdgeGraph(const HermitianMatrix& matrix) : start(static_cast<std::size_t>(matrix.cols()) + 1, 0) {
    const auto each = [&](auto&& visit) {
      for (int column = 0; column < matrix.outerSize(); ++column) {
        for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
          if (it.row() == column) continue;
          visit(column, static_cast<int>(it.row()));
          visit(static_cast<int>(it.row()), column);
        }
      }
    };
    each([&](int a, int) { ++start[a + 1]; });
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    neighbour.resize(static_cast<std::size_t>(start.back()));
    std::vector<int> fill(start.begin(), start.end() - 1);
    each([&](int a, int b) { neighbour[fill[a]++] = b; });
  }
};

std::vector<double> distances_from(int source, const EdgeGraph& graph, const Eigen::Ref<const Positions>& positions) {
  using Item = std::pair<double, int>;
  std::vector<double> distance(graph.start.size() - 1, std::numeric_limits<double>::infinity());
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  distance[source] = 0;
  queue.emplace(0.0, source);
  while (!queue.empty()) {
    const auto [d, vertex] = queue.top();
    queue.pop();
    if (d > distance[vertex]) continue;
    for (int k = graph.start[vertex]; k < graph.start[vertex + 1]; ++k) {
      const int other = graph.neighbour[k];
      const double through = d + (positions.row(other) - positions.row(vertex)).norm();
      if (through < distance[other]) {
        distance[other] = through;
        queue.emplace(through, other);
      }
    }
  }
  return distance;
}

}  // namespace

std::array<int, 2> farthest_boundary_vertices(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions,
                                              const HermitianMatrix& neighbours) {
  const EdgeGraph graph(neighbours);
  std::array<int, 2> pair{loop.front(), loop.front()};
  double farthest = -1;
  constexpr int max_sweeps = 6;     // two are exact on a tree; further ones only lengthen the path
  constexpr double growth = 1e-12;  // above the rounding of a sum of edge lengths, some 1e-13
  int source = loop.front();
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    const std::vector<double> distance = distances_from(source, graph, positions);
    const int target =
        *std::max_element(loop.begin(), loop.end(), [&](int a, int b) { return distance[a] < distance[b]; });
    if (distance[target] <= farthest * (1 + growth)) break;
    farthest = distance[target];
    pair = {source, target};
    source = target;
  }
  return pair;
}

}  // namespace spectral_conformal
