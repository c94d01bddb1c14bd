#include <doctest/doctest.h>

#include <algorithm>

#include "mesh/mirror_symmetry.h"
#include "meshes.h"
#include "seams/cut_surface.h"
#include "seams/handle_cuts.h"

namespace spectral_conformal::test {
namespace {

int no_image(int) { return -1; }

Mesh with_cuts(Mesh mesh, const SeamGraph& graph, const std::vector<std::vector<int>>& cuts) {
  for (const auto& cut : cuts) {
    for (const int edge : cut) mesh.seams.push_back(graph.edges()[edge].vertices);
  }
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("handle_cuts");

TEST_CASE("generator loops of known surfaces, and what is left when all are cut") {
  struct Known {
    Mesh mesh;
    std::size_t loops;
  };
  Mesh slit_torus = torus(12, 8);
  slit_torus.seams = {{0, 1}, {1, 2}};
  for (const Known& known : {Known{torus(12, 8), 2},
                             {double_torus(), 4},
                             {sphere(4), 0},
                             {quad_grid(4, 4), 0},
                             {perforated_grid(7, 4), 0},
                             {ring(9, 1), 1},
                             {slit_torus, 2}}) {
    const SeamGraph graph = SeamGraph::of(known.mesh.view());
    for (const int base : {0, 5}) {
      const auto loops = generator_loops(graph, known.mesh.n_faces(), base);
      CHECK(loops.size() == known.loops);
      if (loops.empty()) continue;
      const Chart cut = only_chart(with_cuts(known.mesh, graph, loops));
      CHECK(cut.orientable);
      CHECK(handle_curves(cut) == 0);
      CHECK(cut.boundary_loops.size() == 1);
    }
  }
}

TEST_CASE("handles are cut open by short loops without making islands") {
  for (const Mesh& mesh : {torus(12, 8), double_torus(), ring(20, 1), ring(20, 3)}) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    CHECK(handle_curves(only_chart(mesh)) > 0);
    const Chart cut = only_chart(with_cuts(mesh, graph, handle_cuts(mesh.view(), graph, no_image)));
    CHECK(cut.orientable);
    CHECK(handle_curves(cut) == 0);
  }
  // Around the tube or along the inner circle, which are as long as each other and the shortest.
  const Mesh doughnut = torus(24, 8);
  const SeamGraph graph = SeamGraph::of(doughnut.view());
  const auto cuts = handle_cuts(doughnut.view(), graph, no_image);
  REQUIRE(cuts.size() == 1);
  double length = 0;
  for (const int edge : cuts[0]) length += graph.edges()[edge].length;
  CHECK(length < 6.29);
}

TEST_CASE("surfaces without handles need no cut") {
  for (const Mesh& mesh : {sphere(3), quad_grid(3, 3), ring(9, 0), perforated_grid(7, 7)}) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    CHECK(handle_cuts(mesh.view(), graph, no_image).empty());
  }
}

TEST_CASE("a symmetric surface gets symmetric cuts") {
  for (const Mesh& mesh : {torus(12, 8), double_torus()}) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
    const auto image = [&](int edge) {
      const auto [a, b] = graph.edges()[edge].vertices;
      return graph.find_edge(symmetry.vertex[a], symmetry.vertex[b]);
    };
    const auto cuts = handle_cuts(mesh.view(), graph, image);
    CHECK(handle_curves(only_chart(with_cuts(mesh, graph, cuts))) == 0);
    for (const auto& cut : cuts) {
      for (const int edge : cut) CHECK(std::find(cut.begin(), cut.end(), image(edge)) != cut.end());
    }
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
