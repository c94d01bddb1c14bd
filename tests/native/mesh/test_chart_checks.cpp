#include <doctest/doctest.h>

#include <limits>
#include <string>

#include "mesh/chart_checks.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

std::string message_of_single_chart(const Mesh& mesh) {
  try {
    single_chart(mesh.view());
  } catch (const InvalidMesh& problem) {
    return problem.what();
  }
  return "";
}

/// What the constructor of Solver says of the mesh's one chart.
std::string message_of_solver(const Mesh& mesh) {
  const Patch patch(mesh);
  try {
    const Solver solver(patch.chart, patch.positions, PatchOptions{});
  } catch (const InvalidMesh& problem) {
    CHECK(problem.what() == why_not_parameterizable(patch.chart, patch.positions));
    return problem.what();
  }
  return "";
}

}  // namespace

TEST_SUITE_BEGIN("chart_checks");

TEST_CASE("what is not one disk-like chart is refused with its name") {
  CHECK(says(message_of_single_chart({}), "no faces"));
  Mesh degenerate = flat_grid(2, 2);
  degenerate.add({0, 1, 1});
  CHECK(says(message_of_single_chart(degenerate), "fewer than three"));
  const Mesh fin({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CHECK(says(message_of_single_chart(fin), "three or more faces"));
  Mesh two = flat_grid(2, 2);
  two.append(flat_grid(1, 1));
  CHECK(says(message_of_single_chart(two), "2 components"));
  CHECK(says(message_of_single_chart(pinched_ring()), "bow ties"));

  CHECK(says(message_of_solver(ring(9, 1)), "non-orientable"));
  CHECK(says(message_of_solver(tetrahedron()), "closed"));
  CHECK(says(message_of_solver(torus(6, 5)), "closed, with 1 handle"));
  Mesh punctured = torus(6, 5);
  punctured.offsets.pop_back();
  punctured.corners.resize(punctured.corners.size() - 4);
  CHECK(says(message_of_solver(punctured), "1 handle and cannot lie flat"));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mesh mesh = flat_grid(2, 2);
    mesh.points[4].y() = bad;
    CHECK(says(message_of_solver(mesh), "Vertex 4 has a coordinate that is not finite"));
  }
  Mesh slit = sphere(2);
  slit.seams.push_back({slit.corners[0], slit.corners[1]});
  CHECK(says(message_of_solver(slit), "two vertices only"));
  Mesh point = flat_grid(2, 2);
  for (auto& p : point.points) p.setConstant(3);
  CHECK(says(message_of_solver(point), "no extent"));
  Mesh line = flat_grid(2, 2);
  for (auto& p : line.points) p = p.x() * Eigen::Vector3d(1, 2, 3);
  CHECK(says(message_of_solver(line), "no area"));
  // A cone whose whole boundary is one point.
  Mesh bag({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}},
           {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {3, 4, 5}});
  const Patch patch(bag);
  CHECK_THROWS_AS(Solver(patch.chart, patch.positions, PatchOptions{}), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
