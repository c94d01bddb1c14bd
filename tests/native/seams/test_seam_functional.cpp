#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "meshes.h"
#include "seams/pieces.h"
#include "seams/seam_functional.h"

namespace spectral_conformal::test {
namespace {

/// A map of faces with these areas, scales and QC.
std::shared_ptr<const TrialMap> map_of(std::vector<double> area, std::vector<double> log2_scale,
                                       std::vector<double> qc) {
  TrialMap map;
  map.solved = true;
  map.sums = DistortionSums(area, log2_scale, qc);
  map.area = std::move(area);
  map.log2_scale = std::move(log2_scale);
  map.qc = std::move(qc);
  return std::make_shared<const TrialMap>(std::move(map));
}

}  // namespace

TEST_SUITE_BEGIN("seam_functional");

TEST_CASE("an isometry costs its seams and islands alone") {
  const Mesh mesh = sphere(4);
  const SeamGraph graph(mesh.view());
  const std::vector<double> price(graph.edges().size(), 3);
  const SeamFunctional functional(graph, price, 4.5);
  const auto isometry = map_of({2, 7}, {0, 0}, {1, 1});
  CHECK(functional({}, {isometry}) == doctest::Approx(0.05));
  CHECK(functional({}, {isometry, isometry}) == doctest::Approx(0.1));
  CHECK(functional.price({0, 1}) == doctest::Approx(3 * (graph.edges()[0].length + graph.edges()[1].length)));
  CHECK(functional({0, 1}, {isometry}) == doctest::Approx(0.05 + functional.price({0, 1}) / 3));
}

TEST_CASE("distortion counts by the rate of its limit, the worst faces most") {
  const Mesh mesh = sphere(4);
  const SeamGraph graph(mesh.view());
  const std::vector<double> price(graph.edges().size(), 1);
  const auto sheared = map_of({1}, {0}, {2});
  const double excess = 2 * (2 + 0.5) - 4;
  CHECK(SeamFunctional(graph, price, 4.5)({}, {sheared}) == doctest::Approx(excess / 0.5 + 0.05));
  CHECK(SeamFunctional(graph, price, 5)({}, {sheared}) == doctest::Approx(excess + 0.05));
  // A tenth of the area: more than a tenth of the distortion.
  const auto partly = map_of({9, 1}, {0, 0}, {1, 2});
  CHECK(SeamFunctional(graph, price, 5)({}, {partly}) == doctest::Approx(excess * std::pow(0.1, 0.25) + 0.05));
}

TEST_CASE("a chart without a map costs more than anything") {
  const Mesh mesh = sphere(4);
  const SeamGraph graph(mesh.view());
  const SeamFunctional functional(graph, std::vector<double>(graph.edges().size(), 1), 4.5);
  CHECK(functional({}, {std::make_shared<const TrialMap>()}) == std::numeric_limits<double>::infinity());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
