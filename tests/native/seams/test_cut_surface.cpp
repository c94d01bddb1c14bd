#include <doctest/doctest.h>

#include <random>

#include "meshes.h"
#include "seams/cut_surface.h"

namespace spectral_conformal::test {
namespace {

/// The handle curves that are left by building all charts anew; -1 where there are several charts.
int rebuilt_handle_curves(Mesh mesh, const SeamGraph& graph, const std::vector<int>& cuts) {
  for (const int edge : cuts) mesh.seams.push_back(graph.edges()[edge].vertices);
  const ChartDecomposition decomposition = build_charts(mesh.view());
  return decomposition.charts.size() == 1 ? handle_curves(decomposition.charts.front()) : -1;
}

Mesh with_reversed_faces(Mesh mesh) {
  for (int f = 0; f < mesh.n_faces(); f += 3) mesh.reverse(f);
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("cut_surface");

TEST_CASE("handle curves of known surfaces") {
  const auto of = [](const Mesh& mesh) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    const Chart chart = build_charts(mesh.view()).charts.front();
    const CutSurface surface = CutSurface::of(mesh.view(), graph);
    CHECK(surface.handle_curves() == handle_curves(chart));
    return surface.handle_curves();
  };
  CHECK(of(sphere(3)) == 0);
  CHECK(of(quad_grid(3, 2)) == 0);
  CHECK(of(perforated_grid(7, 7)) == 0);
  CHECK(of(ring(9, 0)) == 0);
  CHECK(of(ring(9, 1)) > 0);
  CHECK(of(torus(6, 5)) == 2);
  CHECK(of(with_reversed_faces(double_torus())) == 4);
}

TEST_CASE("a cut is made exactly if building the charts anew finds one chart with fewer handle curves") {
  Mesh slit_torus = torus(8, 6);
  slit_torus.seams = {{0, 1}, {1, 2}, {20, 21}};
  std::mt19937 random(3);
  int made = 0;
  int refused = 0;
  for (const Mesh& mesh : {torus(6, 5), double_torus(), with_reversed_faces(torus(7, 4)), slit_torus, ring(12, 1),
                           ring(9, 3), with_reversed_faces(ring(10, 1)), ring(9, 0), perforated_grid(7, 4)}) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    const int n_edges = static_cast<int>(graph.edges().size());
    for (int sample = 0; sample < 6; ++sample) {
      CutSurface surface = CutSurface::of(mesh.view(), graph);
      std::vector<int> cuts;
      for (int step = 0; step < 60; ++step) {
        // Walks of random length, and single edges anywhere: slits, loops, and what parts the surface.
        std::vector<int> candidate;
        int vertex = graph.edges()[random() % n_edges].vertices[0];
        for (unsigned length = 1 + random() % 40; candidate.size() < length;) {
          const auto arcs = graph.adjacency().arcs(vertex);
          const auto& arc = arcs.begin()[random() % static_cast<unsigned>(arcs.end() - arcs.begin())];
          candidate.push_back(arc.edge);
          vertex = arc.to;
        }
        candidate.push_back(static_cast<int>(random() % n_edges));
        std::vector<int> all = cuts;
        all.insert(all.end(), candidate.begin(), candidate.end());
        const int left = rebuilt_handle_curves(mesh, graph, all);
        const bool expected = left >= 0 && left < surface.handle_curves();
        const int before = surface.handle_curves();
        REQUIRE(surface.try_cut(candidate) == expected);
        REQUIRE(surface.handle_curves() == (expected ? left : before));
        (expected ? made : refused) += 1;
        if (expected) cuts = all;
      }
    }
  }
  CHECK(made > 20);
  CHECK(refused > 1000);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
