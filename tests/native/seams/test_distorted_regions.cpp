#include <doctest/doctest.h>

#include <algorithm>

#include "meshes.h"
#include "seams/distorted_regions.h"

namespace spectral_conformal::test {
namespace {

TrialMap map_of(const Mesh& mesh) {
  ChartDecomposition decomposition = build_charts(mesh.view());
  REQUIRE(decomposition.charts.size() == 1);
  TrialMap chart = solve_trial_map(mesh.view(), std::move(decomposition.charts.front()), {}, false, {});
  REQUIRE(chart.solved);
  return chart;
}

bool names(const std::vector<DistortedRegion>& regions, int vertex) {
  return std::any_of(regions.begin(), regions.end(), [&](const auto& region) { return region.vertex == vertex; });
}

}  // namespace

TEST_SUITE_BEGIN("distorted_regions");

TEST_CASE("the tips of spikes are where the scale is smallest") {
  const Mesh mesh = spiky_grid(2, 6);
  const std::vector<DistortedRegion> regions = scale_extrema(mesh.view(), map_of(mesh), 0);
  REQUIRE(regions.size() >= 2);
  for (const int tip : {4 * 17 + 4, 4 * 17 + 12}) CHECK(names(regions, tip));
  for (const DistortedRegion& region : regions) CHECK_FALSE(region.on_loop);
}

TEST_CASE("the far end of a tube is a region on a loop") {
  Mesh tube;
  constexpr int around = 12, rings = 10;
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * 3.14159265358979 * i / around;
      const double radius = 1 - 0.02 * j;  // the lower end is the longer loop
      tube.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.5 * j);
    }
  }
  for (int j = 0; j + 1 < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      tube.add({j * around + i, j * around + next, (j + 1) * around + next, (j + 1) * around + i});
    }
  }
  const std::vector<DistortedRegion> regions = scale_extrema(tube.view(), map_of(tube), 0);
  REQUIRE_FALSE(regions.empty());
  CHECK(std::any_of(regions.begin(), regions.end(), [](const DistortedRegion& region) {
    return region.on_loop && region.vertex >= (rings - 1) * around;
  }));
}

TEST_CASE("a flat patch has none") {
  const Mesh mesh = quad_grid(6, 6);
  CHECK(scale_extrema(mesh.view(), map_of(mesh), 0).empty());
  for (const DistortedRegion& region : angle_peaks(mesh.view(), map_of(mesh))) CHECK(region.volume < 1e-9);
}

TEST_CASE("the angles are worst at the tip of a coarse spike") {
  const Mesh mesh = spiky_grid(1, 5);
  const std::vector<DistortedRegion> regions = angle_peaks(mesh.view(), map_of(mesh));
  const auto worst = std::max_element(regions.begin(), regions.end(),
                                      [](const auto& a, const auto& b) { return a.volume < b.volume; });
  REQUIRE(worst != regions.end());
  const Eigen::Vector3d& p = mesh.points[worst->vertex];
  CHECK((p.head<2>() - Eigen::Vector2d(4, 4)).norm() < 3);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
