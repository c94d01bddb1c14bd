#include <doctest/doctest.h>

#include <algorithm>
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
      solve_trial_map(mesh.view(), std::move(decomposition.charts.front()), {}, false, progress));
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
  chart.sums = DistortionSums(chart.area, chart.log2_scale, chart.qc);
  const MapQuality quality = map_quality({std::make_shared<const TrialMap>(chart)}, 2);
  CHECK(quality.median_log2_scale == 0.5);
  CHECK(quality.within_limit == doctest::Approx(0.9));
  CHECK(quality.mean_qc == doctest::Approx(1.1));
}

TEST_CASE("the energy is the symmetric Dirichlet energy at the median scale, bounded where it is large") {
  const auto energy = [](double log2_scale, double qc) {
    TrialMap chart;
    chart.solved = true;
    chart.area = {3, 1};
    chart.log2_scale = {0.7, 0.7 + log2_scale};
    chart.qc = {1, qc};
    chart.sums = DistortionSums(chart.area, chart.log2_scale, chart.qc);
    return map_quality({std::make_shared<const TrialMap>(chart)}, 2).energy;
  };
  CHECK(energy(0, 1) == doctest::Approx(4));
  const auto exact = [](double scale, double qc) {
    const double s = scale * std::sqrt(qc), t = scale / std::sqrt(qc);
    return 0.75 * 4 + 0.25 * (s * s + t * t + 1 / (s * s) + 1 / (t * t));
  };
  CHECK(energy(0.8, 1.5) == doctest::Approx(exact(std::exp2(0.8), 1.5)));
  CHECK(energy(-0.8, 3.9) == doctest::Approx(exact(std::exp2(-0.8), 3.9)));
  // Continuous where the bound begins, and far below the exact value beyond it.
  CHECK(energy(1.0001, 1) == doctest::Approx(exact(2, 1)).epsilon(1e-3));
  CHECK(energy(-8, 1) < 0.01 * exact(std::exp2(-8), 1));
  CHECK(energy(-8, 1) > energy(-7, 1));
}

TEST_CASE("faces that cover others are defective, and those of a sound map are not") {
  const auto sound = mapped(bumpy_grid(6, 6));
  CHECK(defective_faces(*sound).empty());
  TrialMap folded = *sound;
  for (Eigen::Index v = 0; v < folded.z.size(); ++v) {
    folded.z[v] = Complex(std::abs(folded.z[v].real() - folded.z[0].real()), folded.z[v].imag());
  }
  folded.flipped = {3};
  const std::vector<int> defective = defective_faces(folded);
  CHECK(defective.size() > 1);
  CHECK(std::is_sorted(defective.begin(), defective.end()));
  CHECK(std::count(defective.begin(), defective.end(), 3) == 1);
  folded.solved = false;
  CHECK(defective_faces(folded).empty());
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
