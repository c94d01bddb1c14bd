#include <doctest/doctest.h>

#include <set>

#include "meshes.h"
#include "parameterization/chart_description.h"

namespace spectral_conformal::test {
namespace {

struct Problem {
  Chart chart = Patch(bumpy_grid(4, 3)).chart;
  Positions positions = Patch(bumpy_grid(4, 3)).positions;
  std::vector<TriangleMetric> metric;
  PatchOptions patch;
  SolveOptions solve;
  Pins pins;
  std::string describe() const { return describe_chart(chart, positions, metric, patch, solve, pins); }
};

}  // namespace

TEST_SUITE_BEGIN("chart_description");

TEST_CASE("the same chart has the same description") { CHECK(Problem().describe() == Problem().describe()); }

TEST_CASE("whatever changes the map changes the description") {
  const std::vector<void (*)(Problem&)> changes = {
      [](Problem&) {},
      [](Problem& p) { p.positions(3, 1) = std::nextafter(p.positions(3, 1), 10.0); },
      [](Problem& p) { std::swap(p.chart.triangles[0], p.chart.triangles[1]); },
      [](Problem& p) { p.chart.triangle_weights[0] = 0.5; },
      [](Problem& p) { p.chart.faces.back() += 1; },
      [](Problem& p) { p.chart.reversed_faces = 1; },
      [](Problem& p) { p.metric.resize(p.chart.triangles.size()); },
      [](Problem& p) {
        p.metric.resize(p.chart.triangles.size());
        p.metric.back().xy = 0.1;
      },
      [](Problem& p) { p.patch.weights = Weights::inverse_area; },
      [](Problem& p) { p.patch.boundary = BoundaryMeasure::vertex; },
      [](Problem& p) { p.patch.backend = FactorizationBackend::eigen; },
      [](Problem& p) { p.patch.fill_holes = true; },
      [](Problem& p) { p.patch.fold_free = true; },
      [](Problem& p) { p.patch.polish = true; },
      [](Problem& p) { p.patch.area_blend = 1; },
      [](Problem& p) { p.solve.method = Method::lscm; },
      [](Problem& p) { p.solve.tolerance = 1e-6; },
      [](Problem& p) { p.solve.soft_pins = 1; },
      [](Problem& p) { p.solve.hole_rigidity = 1; },
      [](Problem& p) { p.solve.hole_rigidity = std::nullopt; },
      [](Problem& p) { p.solve.fallbacks = false; },
      [](Problem& p) { p.solve.second_attempt = false; },
      [](Problem& p) {
        p.solve.extenders = {{{0}, {1}, 0.5}};
      },
      [](Problem& p) {
        p.solve.extenders = {{{0}, {1}, 0.25}};
      },
      [](Problem& p) {
        p.solve.extenders = {{{0, 1}, {}, 0.25}};
      },
      [](Problem& p) {
        p.pins = {{0, {0.0, 1.0}}};
      },
      [](Problem& p) {
        p.pins = {{0, {1.0, 0.0}}};
      },
      [](Problem& p) {
        p.pins = {{1, {1.0, 0.0}}};
      },
  };
  std::set<std::string> found;
  for (const auto& change : changes) {
    Problem problem;
    change(problem);
    found.insert(problem.describe());
  }
  CHECK(found.size() == changes.size());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
