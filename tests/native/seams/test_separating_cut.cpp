#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "meshes.h"
#include "seams/separating_cut.h"

namespace spectral_conformal::test {
namespace {

/// The faces of a mesh of quads, or all but some, each with an area of 1.
SeparableFaces all_faces(const Mesh& mesh, const SeamGraph& graph, const std::vector<int>& without = {}) {
  std::vector<int> faces;
  std::vector<Eigen::Vector3d> centers;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    if (std::find(without.begin(), without.end(), f) != without.end()) continue;
    faces.push_back(f);
    centers.emplace_back(Eigen::Vector3d::Zero());
    for (int c = mesh.offsets[f]; c < mesh.offsets[f + 1]; ++c) centers.back() += 0.25 * mesh.points[mesh.corners[c]];
  }
  const std::size_t n = faces.size();
  return {graph, std::move(faces), std::vector<double>(n, 1), std::move(centers)};
}

/// Quads of a 17 x 7 grid that form two squares, joined by a strip one quad wide from x = 7 to x = 10.
Mesh dumbbell() {
  const Mesh grid = quad_grid(17, 7);
  Mesh mesh;
  mesh.points = grid.points;
  for (int f = 0; f < grid.n_faces(); ++f) {
    const int x = f % 17;
    if (x >= 7 && x < 10 && f / 17 != 3) continue;
    mesh.add({grid.corners.begin() + grid.offsets[f], grid.corners.begin() + grid.offsets[f + 1]});
  }
  return mesh;
}

double x_of(const SeparableFaces& faces, int face) { return faces.center[face].x(); }

}  // namespace

TEST_SUITE_BEGIN("separating_cut");

TEST_CASE("the cut goes through the neck, wherever in the two parts the ends are") {
  const Mesh mesh = dumbbell();
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const SeparableFaces faces = all_faces(mesh, graph);
  const int last = mesh.n_faces() - 1;
  for (const auto& [source, sink] : {std::pair{0, last}, {6, last - 3}, {last, 0}}) {
    const std::vector<char> side = separating_side(faces, {source}, {sink}, 0.02);
    double across = 0;
    for (const auto& edge : graph.edges()) {
      if (edge.cut || side[edge.faces[0]] == side[edge.faces[1]]) continue;
      across += edge.length;
      CHECK(std::abs(mesh.points[edge.vertices[0]].x() - 8.5) <= 1.5);
    }
    CHECK(across == doctest::Approx(1));
    CHECK(side[source] == 1);
    CHECK(side[sink] == 0);
  }
}

TEST_CASE("the cut of many faces is short, too, although it is looked for near its level only") {
  const Mesh mesh = quad_grid(500, 120);
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const std::vector<char> side = separating_side(all_faces(mesh, graph), {30000}, {30499}, 0.02);
  double across = 0;
  for (const auto& edge : graph.edges()) {
    if (!edge.cut && side[edge.faces[0]] != side[edge.faces[1]]) across += edge.length;
  }
  CHECK(across == doctest::Approx(120));
}

TEST_CASE("no side is smaller than asked for") {
  const Mesh mesh = dumbbell();
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const std::vector<char> side = separating_side(all_faces(mesh, graph), {0}, {mesh.n_faces() - 1}, 0.6);
  CHECK(std::count(side.begin(), side.end(), 1) == 0);
}

TEST_CASE("distances keep within the faces and do not cross cuts") {
  Mesh mesh = quad_grid(6, 2);
  mesh.seams = {{3, 10}, {10, 17}};
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const SeparableFaces faces = all_faces(mesh, graph);
  const std::vector<double> distance = face_distances(faces, {0});
  for (int f = 0; f < mesh.n_faces(); ++f) CHECK(std::isfinite(distance[f]) == (x_of(faces, f) < 3));
  CHECK(distance[8] == doctest::Approx(3));
  const SeparableFaces fewer = all_faces(mesh, graph, {1, 6});
  CHECK(fewer.index(6) == -1);
  CHECK(fewer.faces[static_cast<std::size_t>(fewer.index(7))] == 7);
  CHECK(std::isinf(face_distances(fewer, {0})[static_cast<std::size_t>(fewer.index(7))]));
}

TEST_CASE("connected parts, the largest first") {
  Mesh mesh = quad_grid(8, 1);
  const SeamGraph graph = SeamGraph::of(mesh.view());
  const auto parts = connected_parts(all_faces(mesh, graph), {0, 2, 3, 4, 6, 7});
  CHECK(parts == std::vector<std::vector<int>>{{2, 3, 4}, {6, 7}, {0}});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
