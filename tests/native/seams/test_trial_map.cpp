#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "seams/trial_map.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

std::shared_ptr<const TrialMap> mapped(const Mesh& mesh, const Progress& progress = {}) {
  ChartDecomposition decomposition = build_charts(mesh.view());
  REQUIRE(decomposition.charts.size() == 1);
  return std::make_shared<const TrialMap>(
      solve_trial_map(mesh.view(), std::move(decomposition.charts.front()), {}, progress));
}

}  // namespace

TEST_SUITE_BEGIN("trial_map");

TEST_CASE("a flat patch is not distorted") {
  for (const Mesh& mesh : {flat_grid(6, 5), quad_grid(6, 5)}) {
    const auto chart = mapped(mesh);
    REQUIRE(chart->solved);
    REQUIRE(chart->area.size() == static_cast<std::size_t>(mesh.n_faces()));
    for (const double scale : chart->log2_scale) CHECK(std::abs(scale) < 1e-9);
    for (const double qc : chart->qc) CHECK(qc - 1 < 1e-9);
    const MapQuality quality = map_quality({chart}, 2);
    CHECK(quality.area > 20);
    CHECK(quality.within_limit == doctest::Approx(1));
    CHECK(quality.distortion() < 1e-9);
  }
}

TEST_CASE("quality is about the median and weighted by area") {
  TrialMap chart;
  chart.solved = true;
  chart.area = {4, 4, 1, 1};
  chart.log2_scale = {0.5, 0.5, 3, -0.25};
  chart.qc = {1, 1, 2, 1};
  const MapQuality quality = map_quality({std::make_shared<const TrialMap>(chart)}, 2);
  CHECK(quality.median_log2_scale == 0.5);
  CHECK(quality.within_limit == doctest::Approx(0.9));
  CHECK(quality.scale_variance == doctest::Approx(0.1 * (2.5 * 2.5 + 0.75 * 0.75)));
  CHECK(quality.mean_qc == doctest::Approx(1.1));
  CHECK(quality.distortion() == doctest::Approx(quality.scale_variance + 0.5));
}

TEST_CASE("what cannot be solved has no map, and infinite distortion") {
  for (const Mesh& mesh : {tetrahedron(), torus(6, 5), ring(9, 1)}) {
    const auto chart = mapped(mesh);
    CHECK_FALSE(chart->solved);
    CHECK(std::isinf(map_quality({chart}, 2).distortion()));
  }
}

TEST_CASE("cancelling passes through") {
  const Mesh mesh = flat_grid(5, 5);
  CHECK_THROWS_AS(mapped(mesh, [](double, const char*) { return false; }), Cancelled);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
