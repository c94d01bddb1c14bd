#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "meshes.h"
#include "seams/trial_map.h"

namespace spectral_conformal::test {
namespace {

std::shared_ptr<const TrialMap> mapped(const Mesh& mesh) {
  ChartDecomposition decomposition = build_charts(mesh.view());
  REQUIRE(decomposition.charts.size() == 1);
  return std::make_shared<const TrialMap>(
      solve_trial_map(mesh.view(), std::move(decomposition.charts.front()), {}, false, {}));
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
  CHECK(quality.mean_qc == doctest::Approx(1.1));
}

TEST_CASE("the energy is the symmetric Dirichlet energy at the median scale, bounded where it is large") {
  const auto energy = [](double log2_scale, double qc) {
    TrialMap chart;
    chart.solved = true;
    chart.area = {3, 1};
    chart.log2_scale = {0.7, 0.7 + log2_scale};
    chart.qc = {1, qc};
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

TEST_CASE("a ratio and its inverse count alike, smoothly beyond the bound") {
  for (const double ratio : {1.0, 1.7, 3.9, 4.1, 30.0, 1e9})
    CHECK(with_inverse(ratio) == doctest::Approx(with_inverse(1 / ratio)));
  CHECK(with_inverse(2) == 2.5);
  const auto slope = [](double ratio) { return (with_inverse(ratio * 1.001) - with_inverse(ratio)) / (0.001 * ratio); };
  CHECK(slope(4.0001) == doctest::Approx(slope(3.99)).epsilon(0.01));
}

TEST_CASE("the median of several charts is that of all their faces, also where many have one scale") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double spread : {0.0, 1e-12, 0.5, 16.0}) {
    TrialMaps charts;
    std::vector<std::pair<double, double>> faces;
    double total = 0;
    for (const int n : {40, 1, 77}) {
      TrialMap chart;
      chart.solved = true;
      for (int f = 0; f < n; ++f) {
        chart.area.push_back(1e-3 + unit(random));
        chart.log2_scale.push_back(spread * (unit(random) - 0.4));
        chart.qc.push_back(1);
        faces.emplace_back(chart.log2_scale.back(), chart.area.back());
        total += chart.area.back();
      }
      charts.push_back(std::make_shared<const TrialMap>(std::move(chart)));
    }
    std::sort(faces.begin(), faces.end());
    double area = 0;
    const auto median = std::find_if(faces.begin(), faces.end(), [&](const auto& face) {
      area += face.second;
      return 2 * area >= total;
    });
    CHECK(map_quality(charts, 2).median_log2_scale == median->first);
  }
  CHECK(map_quality({}, 2).median_log2_scale == 0);
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

TEST_CASE("the side of a map is the longer one of the smallest rectangle around it") {
  CHECK(longer_side(*mapped(quad_grid(5, 2))) == doctest::Approx(5));
  CHECK(longer_side(*mapped(tetrahedron())) == 0);
}

TEST_CASE("what cannot be solved has no map, and infinite distortion") {
  for (const Mesh& mesh : {tetrahedron(), torus(6, 5), ring(9, 1)}) {
    const auto chart = mapped(mesh);
    CHECK_FALSE(chart->solved);
    CHECK(std::isinf(map_quality({chart}, 2).distortion()));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
