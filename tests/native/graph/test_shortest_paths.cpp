#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "graph/shortest_paths.h"

namespace spectral_conformal::test {
namespace {

struct Weighted {
  Adjacency graph;
  std::vector<double> length;
};

/// Few edges, of lengths that make ties, and more than one component.
Weighted random_graph(int n_nodes, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::array<int, 2>> edges;
  std::vector<double> length;
  for (int e = 0; e < 2 * n_nodes; ++e) {
    edges.push_back({static_cast<int>(random() % n_nodes), static_cast<int>(random() % n_nodes)});
    length.push_back(static_cast<double>(random() % 4));
  }
  return {Adjacency(n_nodes, edges), length};
}

ShortestPathSearch search_all(const Weighted& weighted, const std::vector<int>& sources, std::vector<int>& settled) {
  ShortestPathSearch search(weighted.graph.n_nodes());
  for (const int source : sources) search.offer(source, 0);
  for (int node = search.settle(); node >= 0; node = search.settle()) {
    settled.push_back(node);
    for (const auto& arc : weighted.graph.arcs(node)) {
      search.offer(arc.to, search.distance(node) + weighted.length[arc.edge], node);
    }
  }
  return search;
}

/// Bellman and Ford: relaxes all arcs until nothing changes.
std::vector<double> relaxed(const Weighted& weighted, const std::vector<int>& sources) {
  std::vector<double> distance(static_cast<std::size_t>(weighted.graph.n_nodes()),
                               std::numeric_limits<double>::infinity());
  for (const int source : sources) distance[source] = 0;
  for (int round = 0; round < weighted.graph.n_nodes(); ++round) {
    for (int node = 0; node < weighted.graph.n_nodes(); ++node) {
      for (const auto& arc : weighted.graph.arcs(node)) {
        distance[arc.to] = std::min(distance[arc.to], distance[node] + weighted.length[arc.edge]);
      }
    }
  }
  return distance;
}

}  // namespace

TEST_SUITE_BEGIN("shortest_paths");

TEST_CASE("distances are those of relaxing all arcs, and the paths have that length") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Weighted weighted = random_graph(40, seed);
    std::vector<int> settled;
    const ShortestPathSearch search = search_all(weighted, {3, 17}, settled);
    CHECK(search.distances() == relaxed(weighted, {3, 17}));
    for (const int node : settled) {
      const int previous = search.previous(node);
      if (previous < 0) {
        CHECK(search.distance(node) == 0);
        continue;
      }
      const auto arcs = weighted.graph.arcs(previous);
      CHECK(std::any_of(arcs.begin(), arcs.end(), [&](const auto& arc) {
        return arc.to == node && search.distance(previous) + weighted.length[arc.edge] == search.distance(node);
      }));
    }
  }
}

TEST_CASE("every reachable node is settled once, near ones first") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Weighted weighted = random_graph(40, seed);
    std::vector<int> settled;
    const ShortestPathSearch search = search_all(weighted, {0}, settled);
    for (std::size_t i = 1; i < settled.size(); ++i) {
      CHECK(search.distance(settled[i - 1]) <= search.distance(settled[i]));
    }
    std::sort(settled.begin(), settled.end());
    CHECK(std::adjacent_find(settled.begin(), settled.end()) == settled.end());
    const std::vector<double> distances = search.distances();
    const auto finite = [](double distance) { return std::isfinite(distance); };
    CHECK(static_cast<std::ptrdiff_t>(settled.size()) == std::count_if(distances.begin(), distances.end(), finite));
  }
}

TEST_CASE("of ties the smaller number is settled first, and the first path stays") {
  ShortestPathSearch search(6);
  for (const int node : {5, 2, 4}) search.offer(node, 1);
  search.offer(2, 1, 5);
  CHECK(search.settle() == 2);
  CHECK(search.previous(2) == -1);
  search.offer(3, 1, 2);
  search.offer(3, 1, 4);
  for (const int node : {3, 4, 5, -1}) CHECK(search.settle() == node);
  CHECK(search.previous(3) == 2);
  CHECK(std::isinf(search.distance(0)));
}

TEST_CASE("steps count arcs") {
  const Adjacency graph(6, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}});
  CHECK(steps_from(graph, {0}) == std::vector<int>{0, 1, 2, 1, -1, -1});
  CHECK(steps_from(graph, {0, 2}) == std::vector<int>{0, 1, 0, 1, -1, -1});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
