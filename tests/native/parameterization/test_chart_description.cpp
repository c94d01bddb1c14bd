#include <doctest/doctest.h>

#include <bitset>
#include <set>
#include <string>

#include "meshes.h"
#include "parameterization/chart_description.h"

namespace spectral_conformal::test {
namespace {

struct Described {
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

TEST_CASE("the same chart has the same description") { CHECK(Described().describe() == Described().describe()); }

TEST_CASE("whatever changes the map changes the description") {
  const std::vector<void (*)(Described&)> changes = {
      [](Described&) {},
      [](Described& p) { p.positions(3, 1) = std::nextafter(p.positions(3, 1), 10.0); },
      [](Described& p) {
        std::vector<std::array<int, 3>> triangles = p.chart.triangles;
        std::swap(triangles[0], triangles[1]);
        p.chart.triangles = std::move(triangles);
      },
      [](Described& p) {
        std::vector<TriangleWeight> weights = p.chart.triangle_weights;
        weights[0] = split_of_quad;
        p.chart.triangle_weights = std::move(weights);
      },
      [](Described& p) { p.chart.faces.back() += 1; },
      [](Described& p) { p.chart.reversed_faces = 1; },
      [](Described& p) { p.metric.resize(p.chart.triangles.size()); },
      [](Described& p) {
        p.metric.resize(p.chart.triangles.size());
        p.metric.back().xy = 0.1;
      },
      [](Described& p) { p.patch.weights = Weights::inverse_area; },
      [](Described& p) { p.patch.boundary = BoundaryMeasure::vertex; },
      [](Described& p) { p.patch.backend = FactorizationBackend::eigen; },
      [](Described& p) { p.patch.fill_holes = true; },
      [](Described& p) { p.solve.fold_free = true; },
      [](Described& p) { p.solve.polish = Polish::angles; },
      [](Described& p) { p.solve.polish = Polish::balanced; },
      [](Described& p) { p.patch.area_blend = 1; },
      [](Described& p) { p.solve.method = Method::lscm; },
      [](Described& p) { p.solve.tolerance = 1e-6; },
      [](Described& p) { p.solve.soft_pins = 1; },
      [](Described& p) { p.solve.hole_rigidity = 1; },
      [](Described& p) { p.solve.hole_rigidity = std::nullopt; },
      [](Described& p) { p.solve.fallbacks = false; },
      [](Described& p) { p.solve.second_attempt = false; },
      [](Described& p) {
        p.solve.extenders = {{{0}, {1}, 0.5}};
      },
      [](Described& p) {
        p.solve.extenders = {{{0}, {1}, 0.25}};
      },
      [](Described& p) {
        p.solve.extenders = {{{0, 1}, {}, 0.25}};
      },
      [](Described& p) {
        p.pins = {{0, {0.0, 1.0}}};
      },
      [](Described& p) {
        p.pins = {{0, {1.0, 0.0}}};
      },
      [](Described& p) {
        p.pins = {{1, {1.0, 0.0}}};
      },
  };
  std::set<std::string> found;
  for (const auto& change : changes) {
    Described problem;
    change(problem);
    found.insert(problem.describe());
  }
  CHECK(found.size() == changes.size());
}

TEST_CASE("every bit of the positions changes about half of a digest of 128 bits") {
  Described problem;
  const std::string before = problem.describe();
  REQUIRE(before.size() == 16);
  std::set<std::string> found{before};
  std::size_t n_changed = 0;
  const std::size_t n_bits = 64 * static_cast<std::size_t>(problem.positions.size());
  for (std::size_t i = 0; i < n_bits; ++i) {
    const auto flip = [&] {
      auto* const bytes = reinterpret_cast<unsigned char*>(problem.positions.data());
      bytes[i / 8] = static_cast<unsigned char>(bytes[i / 8] ^ (1U << (i % 8)));
    };
    flip();
    const std::string after = problem.describe();
    flip();
    found.insert(after);
    for (std::size_t k = 0; k < after.size(); ++k) {
      n_changed += std::bitset<8>(static_cast<unsigned char>(after[k] ^ before[k])).count();
    }
  }
  CHECK(found.size() == n_bits + 1);
  const double mean = static_cast<double>(n_changed) / static_cast<double>(n_bits);
  CHECK(mean > 63);
  CHECK(mean < 65);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
