#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

#include "meshes.h"
#include "seams/loop_grid.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("loop_grid");

TEST_CASE("a torus has one grid, with the loops of each family in order around") {
  const SeamGraph graph = SeamGraph::of(torus(12, 8).view());
  const EdgeLoops loops = EdgeLoops::of(graph);
  const std::vector<LoopGrid> grids = LoopGrid::of(graph, loops);
  REQUIRE(grids.size() == 1);
  for (const std::vector<int>& family : grids[0].families) {
    for (std::size_t i = 0; i < family.size(); ++i) {
      // An edge joins each loop to the next one.
      std::vector<char> is_on(static_cast<std::size_t>(graph.n_vertices()), 0);
      for (const int e : loops.loops[family[i]]) {
        for (const int v : graph.edges()[e].vertices) is_on[v] = 1;
      }
      std::size_t n_beside = 0;
      for (const int e : loops.loops[family[(i + 1) % family.size()]]) {
        for (const auto& arc : graph.adjacency().arcs(graph.edges()[e].vertices[0])) n_beside += is_on[arc.to];
      }
      CHECK(n_beside == loops.loops[family[i]].size());
    }
  }
  CHECK(grids[0].families[0].size() + grids[0].families[1].size() == 20);
}

TEST_CASE("no grid where loops end, or do not cross those of another family once") {
  for (const Mesh& mesh : {quad_grid(4, 3), cell_surface(3, [](int, int, int) { return true; })}) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    CHECK(LoopGrid::of(graph, EdgeLoops::of(graph)).empty());
  }
}

TEST_CASE("evenly spaced loops begin with the cheapest choice; those that cost the same are alike") {
  const std::vector<int> family{3, 4, 5, 6, 7, 8, 9, 10};
  std::vector<double> costs(11, 2.0);
  CHECK(evenly_spaced(family, 2, costs) == std::vector<std::vector<int>>{{3, 7}});
  costs[9] = 1.0;
  CHECK(evenly_spaced(family, 2, costs) == std::vector<std::vector<int>>{{5, 9}, {6, 10}, {7, 3}, {8, 4}});
  CHECK(evenly_spaced(family, 1, costs) == std::vector<std::vector<int>>{{9}, {3}, {5}, {7}});
  // Of five, three are never alike after a shift.
  const std::vector<int> few{0, 1, 2, 3, 4};
  costs[0] = 1.0;
  CHECK(evenly_spaced(few, 3, costs) == std::vector<std::vector<int>>{{0, 1, 3}, {1, 2, 4}, {2, 3, 0}, {3, 4, 1}});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
