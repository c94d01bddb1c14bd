#include <doctest/doctest.h>

#include "meshes.h"
#include "parameterization/mesh_cut.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("mesh_cut");

TEST_CASE("extenders go to the charts that have copies of both vertices") {
  Mesh mesh = bumpy_grid(2, 2);
  const int second = static_cast<int>(mesh.points.size());
  mesh.append(bumpy_grid(2, 2));
  const MeshCut cut = cut_mesh(mesh.view(), {});
  REQUIRE(cut.decomposition.charts.size() == 2);
  const std::vector<VertexExtender> extenders{{0, 1, 0.5}, {0, second, 1}, {second + 2, second + 1, -1},
                                              {1, 1, 1},   {-1, 0, 1},     {2, 0, 0}};
  const std::vector<ChartExtenders> result = extenders_of_charts(cut, extenders);
  REQUIRE(result.size() == 2);
  CHECK(result[0].numbers == std::vector<std::size_t>{0, 5});
  CHECK(result[1].numbers == std::vector<std::size_t>{2});
  const Extender& last = result[1].extenders.front();
  CHECK(last.strength == -1);
  REQUIRE(last.from.size() == 1);
  CHECK(cut.decomposition.charts[1].vertices[static_cast<std::size_t>(last.from.front())] == second + 2);
}

TEST_CASE("an extender has all copies of a vertex in a chart") {
  Mesh mesh = ring(12, 0);
  mesh.seams = {{0, 1}};
  const MeshCut cut = cut_mesh(mesh.view(), {});
  const std::vector<ChartExtenders> result = extenders_of_charts(cut, {{0, 12, 1}});
  REQUIRE(result.size() == 1);
  CHECK(result[0].extenders.front().from.size() == 2);
  CHECK(result[0].extenders.front().to.size() == 1);
}

TEST_CASE("equations between charts have no effect") {
  Mesh mesh = bumpy_grid(1, 1);
  const int second = static_cast<int>(mesh.corners.size());
  mesh.append(bumpy_grid(1, 1));
  LinearEquations equations;
  equations.add({{0, 1.0}, {2 * second, -1.0}});
  equations.add({{2 * second + 1, 1.0}, {2 * second + 3, -1.0}});
  const std::vector<LinearEquations> result = equations_of_charts(cut_mesh(mesh.view(), {}), equations);
  REQUIRE(result.size() == 2);
  CHECK(result[0].empty());
  CHECK(result[1].size() == 1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
