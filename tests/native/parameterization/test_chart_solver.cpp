#include <doctest/doctest.h>

#include "meshes.h"
#include "parameterization/chart_solver.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("chart_solver");

TEST_CASE("a chart is solved repeatedly with the same result") {
  const Mesh mesh = bumpy_grid(5, 4);
  const MeshCut cut = cut_mesh(mesh.view(), {});
  const Chart& chart = cut.decomposition.charts.front();
  const UnwrapOptions options;
  ChartSolver solver(chart_task(cut, chart, options, {}));
  const ChartSolution first = solver.solve({}, std::nullopt, 1e-10, {});
  const ChartSolution second = solver.solve({}, std::nullopt, 1e-10, {});
  CHECK(first.report.solved);
  CHECK(first.report.flipped == 0);
  CHECK(first.report.mean_qc >= 1);
  CHECK(first.report.max_qc >= first.report.mean_qc);
  CHECK(first.z == second.z);
}

TEST_CASE("a task that is not possible says why, one without memory how large it is") {
  const Mesh mesh = bumpy_grid(3, 3);
  const MeshCut cut = cut_mesh(mesh.view(), {});
  UnwrapOptions options;
  options.solve.method = Method::fiedler;
  options.vertex_pins = {{0, 0}, {3, 1}, {5, Complex(0, 1)}};
  ChartSolver solver(chart_task(cut, cut.decomposition.charts.front(), options, {}));
  CHECK_FALSE(solver.task().is_possible);
  const ChartSolution none = solver.solve({}, std::nullopt, 1e-10, {});
  CHECK_FALSE(none.report.solved);
  CHECK(none.report.steps.front().reason == Rejection::method_without_pins);
  const Step step = out_of_memory(solver.task()).report.steps.front();
  CHECK(step.kind == StepKind::out_of_memory);
  CHECK(step.count == static_cast<int>(cut.decomposition.charts.front().faces.size()));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
