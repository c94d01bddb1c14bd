#include <doctest/doctest.h>

#include <limits>

#include "mesh/chart_checks.h"
#include "meshes.h"
#include "refusal.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

/// What single_chart refuses the mesh for; count is that of the step.
Rejection refused_as_single_chart(const Mesh& mesh, int count) {
  const Step step = refusal([&] { single_chart(mesh.view()); });
  CHECK(step.count == count);
  return step.reason;
}

/// The condition that the constructor of Solver misses of the mesh's one chart; count is that of the step.
Rejection reason_of_solver(const Mesh& mesh, int count = 0) {
  const Patch patch(mesh);
  try {
    const Solver solver = Solver::of(patch.chart, patch.positions, PatchOptions{});
  } catch (const InvalidMesh& problem) {
    const std::optional<Step> step = why_not_parameterizable(patch.chart, patch.positions);
    REQUIRE(step);
    CHECK((problem.step().reason == step->reason && problem.step().count == step->count));
    CHECK(step->count == count);
    return step->reason;
  }
  return Rejection::none;
}

}  // namespace

TEST_SUITE_BEGIN("chart_checks");

TEST_CASE("what is not one disk-like chart is refused with its name") {
  CHECK(refused_as_single_chart({}, 0) == Rejection::no_faces);
  Mesh degenerate = flat_grid(2, 2);
  degenerate.add({0, 1, 1});
  CHECK(refused_as_single_chart(degenerate, degenerate.n_faces() - 1) == Rejection::degenerate_face);
  const Mesh fin({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CHECK(refused_as_single_chart(fin, 1) == Rejection::non_manifold_edges);
  Mesh two = flat_grid(2, 2);
  two.append(flat_grid(1, 1));
  CHECK(refused_as_single_chart(two, 2) == Rejection::several_components);
  CHECK(refused_as_single_chart(pinched_ring(), 1) == Rejection::bow_ties);

  CHECK(reason_of_solver(flat_grid(2, 2)) == Rejection::none);
  CHECK(reason_of_solver(ring(9, 1)) == Rejection::not_orientable);
  CHECK(reason_of_solver(tetrahedron()) == Rejection::closed);
  CHECK(reason_of_solver(torus(6, 5), 1) == Rejection::closed);
  Mesh punctured = torus(6, 5);
  punctured.offsets.pop_back();
  punctured.corners.resize(punctured.corners.size() - 4);
  CHECK(reason_of_solver(punctured, 1) == Rejection::handles);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mesh mesh = flat_grid(2, 2);
    mesh.points[4].y() = bad;
    CHECK(reason_of_solver(mesh, 4) == Rejection::vertex_not_finite);
  }
  Mesh slit = sphere(2);
  slit.seams.push_back({slit.corners[0], slit.corners[1]});
  CHECK(reason_of_solver(slit) == Rejection::border_of_two);
  Mesh point = flat_grid(2, 2);
  for (auto& p : point.points) p.setConstant(3);
  CHECK(reason_of_solver(point) == Rejection::no_extent);
  Mesh line = flat_grid(2, 2);
  for (auto& p : line.points) p = p.x() * Eigen::Vector3d(1, 2, 3);
  CHECK(reason_of_solver(line) == Rejection::no_surface);
  // A cone whose whole boundary is one point.
  Mesh bag({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}},
           {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {3, 4, 5}});
  const Patch patch(bag);
  CHECK_THROWS_AS(Solver::of(patch.chart, patch.positions, PatchOptions{}), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
