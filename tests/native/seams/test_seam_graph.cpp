#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "concurrency/work_counter.h"
#include "meshes.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

bool everywhere(int, int) { return true; }

std::vector<char> only(const SeamGraph& graph, int vertex) {
  std::vector<char> targets(static_cast<std::size_t>(graph.n_vertices()), 0);
  targets[vertex] = 1;
  return targets;
}

int turns(const Mesh& mesh, const SeamGraph& graph, const std::vector<int>& path) {
  int count = 0;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (const int edge : path) {
    const auto [a, b] = graph.edges()[edge].vertices;
    const Eigen::Vector3d direction = (mesh.points[b] - mesh.points[a]).cwiseAbs();
    if (!last.isZero() && !direction.isApprox(last)) ++count;
    last = direction;
  }
  return count;
}

}  // namespace

TEST_SUITE_BEGIN("seam_graph");

TEST_CASE("edges on the border, seams and edges of three faces are cut") {
  Mesh mesh = quad_grid(3, 2);
  mesh.seams = {{6, 5}, {0, 11}};
  const SeamGraph graph = SeamGraph::of(mesh.view());
  CHECK(graph.edges().size() == 17);
  CHECK(graph.find_edge(0, 11) == -1);
  CHECK(graph.edges()[graph.find_edge(5, 6)].cut);
  CHECK(graph.edges()[graph.find_edge(0, 1)].cut);
  CHECK_FALSE(graph.edges()[graph.find_edge(1, 5)].cut);
  Mesh fin({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const SeamGraph finned = SeamGraph::of(fin.view());
  CHECK(finned.edges()[finned.find_edge(0, 1)].cut);
}

TEST_CASE("the cut edges at a vertex are counted, each once") {
  Mesh mesh = quad_grid(3, 3);
  mesh.seams = {{4, 5}};
  SeamGraph graph = SeamGraph::of(mesh.view());
  CHECK(graph.n_cuts(0) == 2);
  const int from_border = graph.find_edge(1, 5);
  CHECK(graph.n_cuts(1) == 2);
  CHECK(graph.n_cuts(5) == 1);
  for (int twice = 0; twice < 2; ++twice) graph.cut(from_border);
  CHECK(graph.n_cuts(1) == 3);
  CHECK(graph.n_cuts(5) == 2);
  graph.uncut(from_border);
  CHECK(graph.n_cuts(1) == 2);
  CHECK(graph.n_cuts(5) == 1);
}

TEST_CASE("of the many shortest ways over a grid one with a single turn is taken") {
  const Mesh mesh = quad_grid(9, 7);
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const std::vector<int> path = graph.path(11, only(graph, 68), [&](int e, int) { return !graph.edges()[e].cut; });
  CHECK(path.size() == 12);
  CHECK(turns(mesh, graph, path) == 1);
}

TEST_CASE("cut edges are free and forbidden edges are not walked") {
  const Mesh mesh = quad_grid(6, 6);
  const SeamGraph graph = SeamGraph::of(mesh.view());
  for (const int edge : graph.path(8, only(graph, 40), everywhere)) {
    const bool on_border = graph.edges()[edge].cut;
    const auto& ends = graph.edges()[edge].vertices;
    const bool at_an_end = std::any_of(ends.begin(), ends.end(), [](int v) { return v == 8 || v == 40; });
    CHECK((on_border || at_an_end));
  }
  CHECK(graph.path(8, only(graph, 40), [](int, int) { return false; }).empty());
  CHECK(graph.path(8, only(graph, 8), everywhere).empty());
}

TEST_CASE("folded edges are cheaper, concave ones most") {
  Mesh mesh = quad_grid(4, 2);
  for (Eigen::Vector3d& p : mesh.points) p.z() = std::abs(p.x() - 1) < 0.5 ? 0.2 : std::abs(p.x() - 3) < 0.5 ? -0.2 : 0;
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const auto relative = [&](int a, int b) {
    const auto& edge = graph.edges()[graph.find_edge(a, b)];
    return edge.cost / edge.length;
  };
  const double ridge = relative(1, 6);
  const double valley = relative(3, 8);
  CHECK(valley < ridge);
  CHECK(ridge < 1);
  CHECK(relative(5, 6) == doctest::Approx(2));
}

TEST_CASE("the angle between the faces is that of their normals") {
  for (const double degrees : {0.0, 1.0, 35.0, 90.0, 179.0}) {
    const double angle = degrees * M_PI / 180;
    SeamGraph::Edge edge{{0, 1}, {0, 1}, 1, 1, false};
    edge.normal = Eigen::Vector3d(1 + std::cos(angle), std::sin(angle), 0);
    CHECK(SeamGraph::dihedral_angle(edge) == doctest::Approx(angle).epsilon(1e-6));
  }
}

TEST_CASE("distances and the tree that they come from") {
  const Mesh mesh = quad_grid(5, 5);
  SeamGraph graph = SeamGraph::of(mesh.view());
  std::vector<int> parent;
  const auto inner = [&](int edge) { return !graph.edges()[edge].cut; };
  const std::vector<double> distance = graph.distances({7}, inner, &parent);
  CHECK(distance[7] == 0);
  CHECK(parent[7] == -1);
  CHECK(distance[28] == doctest::Approx(12));
  CHECK(graph.edges()[parent[8]].vertices == std::array<int, 2>{7, 8});
  CHECK(std::isinf(distance[0]));
}

TEST_CASE("a mesh that is none is refused") {
  Mesh mesh = quad_grid(2, 2);
  mesh.corners[0] = 99;
  CHECK_THROWS_AS(SeamGraph::of(mesh.view()), InvalidMesh);
}

TEST_CASE("an edge is found among thousands in one vertex, and paths over it grow with their number") {
  std::vector<double> steps;
  for (const int n : {4000, 8000}) {
    Mesh fan;
    for (int i = 0; i < n; ++i) fan.points.emplace_back(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0);
    fan.points.emplace_back(0, 0, 0.2);
    for (int i = 0; i < n; ++i) fan.add({i, (i + 1) % n, n});
    const SeamGraph graph = SeamGraph::of(fan.view());
    const WorkCounter counter;
    for (const auto& edge : graph.edges()) {
      const auto [a, b] = edge.vertices;
      REQUIRE(graph.find_edge(a, b) == graph.find_edge(b, a));
      REQUIRE(graph.edges()[graph.find_edge(a, b)].vertices == edge.vertices);
    }
    CHECK(graph.find_edge(0, n / 2) == -1);
    const auto inside = [&](int e, int) { return !graph.edges()[e].cut; };
    CHECK(graph.path(0, only(graph, n / 2), inside).size() == 2);
    // Nothing is reached, so that all ways are looked at.
    CHECK(graph.path(0, std::vector<char>(graph.n_vertices(), 0), everywhere).empty());
    steps.push_back(static_cast<double>(counter.counts().steps));
  }
  CHECK(steps[1] <= 2.5 * steps[0]);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
