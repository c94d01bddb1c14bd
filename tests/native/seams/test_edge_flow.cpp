#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "meshes.h"
#include "seams/edge_flow.h"
#include "seams/seam_graph.h"

namespace spectral_conformal::test {
namespace {

/// Every quad as two triangles.
Mesh halved(const Mesh& quads) {
  Mesh mesh;
  mesh.points = quads.points;
  for (int f = 0; f < quads.n_faces(); ++f) {
    const int* const c = quads.corners.data() + quads.offsets[f];
    mesh.add({c[0], c[1], c[2]});
    mesh.add({c[0], c[2], c[3]});
  }
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("edge_flow");

TEST_CASE("the edge loops of a torus are its two families of circles, also where its quads are triangles") {
  const Mesh quads = torus(12, 8);
  for (const Mesh& mesh : {quads, halved(quads)}) {
    const SeamGraph graph = SeamGraph::of(mesh.view());
    const EdgeLoops found = EdgeLoops::of(graph);
    REQUIRE(found.loops.size() == 12 + 8);
    std::set<int> families[2];
    for (std::size_t i = 0; i < found.loops.size(); ++i) {
      const bool is_long = found.loops[i].size() == 12;
      CHECK((is_long || found.loops[i].size() == 8));
      families[is_long ? 1 : 0].insert(found.family[i]);
      CHECK(graph.turning(found.loops[i]) == 0);
    }
    CHECK(families[0].size() == 1);
    CHECK(families[1].size() == 1);
    CHECK(families[0] != families[1]);
  }
}

TEST_CASE("edges go straight on where four quads meet, and nowhere else") {
  const Mesh cube = cell_surface(3, [](int, int, int) { return true; });
  const SeamGraph graph = SeamGraph::of(cube.view());
  for (std::size_t e = 0; e < graph.edges().size(); ++e) {
    for (const int v : graph.edges()[e].vertices) {
      const auto arcs = graph.adjacency().arcs(v);
      const int next = graph.onward(static_cast<int>(e), v);
      CHECK((next >= 0) == (arcs.end() - arcs.begin() == 4));
      if (next >= 0) CHECK(graph.onward(next, v) == static_cast<int>(e));
    }
  }
  const SeamGraph border = SeamGraph::of(quad_grid(1, 2).view());
  for (std::size_t e = 0; e < border.edges().size(); ++e) {
    for (const int v : border.edges()[e].vertices) CHECK(border.onward(static_cast<int>(e), v) < 0);
  }
}

TEST_CASE("equilateral triangles make no quads") {
  Mesh mesh = quad_grid(6, 6);
  for (Eigen::Vector3d& p : mesh.points) p = {p.x() - 0.5 * p.y(), std::sqrt(0.75) * p.y(), 0};
  const SeamGraph graph = SeamGraph::of(halved(mesh).view());
  const std::vector<int>& quad = graph.flow().quad;
  CHECK(std::all_of(quad.begin(), quad.end(), [](int q) { return q < 0; }));
  CHECK(EdgeLoops::of(graph).loops.empty());
}

TEST_CASE("a seam pays for leaving its edge loop, not for bending with it") {
  SeamGraph graph = SeamGraph::of(quad_grid(4, 4).view());
  const auto path = [&](std::initializer_list<int> vertices) {
    std::vector<int> edges;
    for (const int* v = vertices.begin(); v + 1 != vertices.end(); ++v) edges.push_back(graph.find_edge(*v, *(v + 1)));
    return edges;
  };
  CHECK(graph.turning(path({10, 11, 12, 13, 14})) == 0);
  // Two right angles: an edge each.
  CHECK(graph.turning(path({10, 11, 12, 17, 18})) ==
        doctest::Approx(2 * graph.edges()[path({11, 12})[0]].cost).epsilon(1e-6));
  graph.scale_turns(0.5);
  CHECK(graph.turning(path({10, 11, 12, 17, 18})) ==
        doctest::Approx(graph.edges()[path({11, 12})[0]].cost).epsilon(1e-6));
  // And an end inside, which costs as much as a right angle.
  graph.set_least_turn(3);
  CHECK(graph.turning(path({10, 11, 12, 17, 18})) ==
        doctest::Approx(1.5 * (graph.edges()[path({11, 12})[0]].cost + 3)).epsilon(1e-6));
  graph.scale_turns(0);
  CHECK(graph.turning(path({10, 11, 12, 17, 18})) == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
