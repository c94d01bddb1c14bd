#include <doctest/doctest.h>

#include "meshes.h"
#include "parameterization/chart_metric.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("chart_metric");

TEST_CASE("each triangle gets the metric of its face, in the frame of its first side") {
  Mesh mesh = quad_grid(2, 1);
  std::vector<SpaceMetric> metric(2, SpaceMetric::Identity());
  metric[1](0, 0) = 4;
  const Patch patch(mesh);
  const std::vector<TriangleMetric> result = chart_metric(mesh.view(), patch.chart, metric.data());
  REQUIRE(result.size() == patch.chart.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) {
    const bool stretched = patch.chart.faces[patch.chart.triangle_face[t]] == 1;
    CHECK(result[t].xx * result[t].yy - result[t].xy * result[t].xy == doctest::Approx(stretched ? 4 : 1));
    CHECK(result[t].xx + result[t].yy == doctest::Approx(stretched ? 5 : 2));
  }
  CHECK(chart_metric(mesh.view(), patch.chart, nullptr).empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
