#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "linear_algebra/nested_dissection.h"
#include "linear_algebra/supernodal_factor.h"
#include "meshes.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::test {
namespace {

Adjacency graph_of_energy(const Patch& patch) { return graph_of(patch.energy(Weights::uniform).matrix()); }

std::vector<int> all(int n) {
  std::vector<int> result(static_cast<std::size_t>(n));
  std::iota(result.begin(), result.end(), 0);
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("nested_dissection");

TEST_CASE("every node once; leaves are small and not joined to each other") {
  for (const Mesh& mesh : {bumpy_grid(120, 90), quad_grid(110, 100), perforated_grid(90, 90)}) {
    const Patch patch(mesh);
    const Adjacency graph = graph_of_energy(patch);
    const NestedDissection found = nested_dissection(graph, patch.positions);
    std::vector<int> sorted = found.order;
    std::sort(sorted.begin(), sorted.end());
    CHECK(sorted == all(graph.n_nodes()));
    std::vector<int> leaf_of(found.order.size(), -1);
    int end = 0;
    for (std::size_t k = 0; k < found.leaves.size(); ++k) {
      const auto [begin, leaf_end] = found.leaves[k];
      CHECK(begin < leaf_end);
      CHECK(leaf_end - begin <= 2000);
      end += leaf_end - begin;
      for (int i = begin; i < leaf_end; ++i) leaf_of[found.order[i]] = static_cast<int>(k);
    }
    CHECK(found.leaves.size() >= 4);
    // The rest are separators: of n nodes on a square some of the square root of n, for each halving.
    CHECK(graph.n_nodes() - end < 0.1 * graph.n_nodes());
    for (int node = 0; node < graph.n_nodes(); ++node) {
      for (const auto& arc : graph.arcs(node)) {
        if (leaf_of[node] >= 0 && leaf_of[arc.to] >= 0) CHECK(leaf_of[node] == leaf_of[arc.to]);
      }
    }
  }
}

TEST_CASE("a strip is cut across") {
  const Patch patch(flat_grid(1000, 6));
  const Adjacency graph = graph_of_energy(patch);
  const NestedDissection found = nested_dissection(graph, patch.positions);
  REQUIRE(found.leaves.size() == 4);
  for (const auto& [begin, end] : found.leaves) CHECK(end - begin > graph.n_nodes() / 5);
  CHECK(found.leaves[1][0] == found.leaves[0][1]);
  // Seven nodes: the first cut at the end, those of the halves behind their leaves.
  CHECK(found.leaves[2][0] == found.leaves[1][1] + 7);
  CHECK(found.leaves[3][1] == graph.n_nodes() - 14);
}

TEST_CASE("the order does not depend on the threads") {
  const Patch patch(bumpy_grid(200, 200));
  const Adjacency graph = graph_of_energy(patch);
  std::vector<std::vector<int>> orders;
  for (const unsigned limit : {1U, 2U, 5U}) {
    const ThreadLimit threads(limit);
    orders.push_back(nested_dissection(graph, patch.positions).order);
  }
  CHECK(orders[0] == orders[1]);
  CHECK(orders[0] == orders[2]);
}

TEST_CASE("nodes all at one place, on a line, without edges, or none") {
  const Patch patch(bumpy_grid(60, 60));
  const Adjacency graph = graph_of_energy(patch);
  const int n = graph.n_nodes();
  const NestedDissection at_one_place = nested_dissection(graph, Positions::Zero(n, 3));
  CHECK(at_one_place.order == all(n));
  REQUIRE(at_one_place.leaves.size() == 1);
  CHECK(at_one_place.leaves[0][1] == n);
  Positions on_line = patch.positions;
  on_line.rightCols<2>().setZero();
  CHECK(nested_dissection(graph, on_line).leaves.size() > 1);
  CHECK(nested_dissection(Adjacency(n, {}), patch.positions).leaves.size() > 1);
  CHECK(nested_dissection(Adjacency(0, {}), Positions(0, 3)).order.empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
