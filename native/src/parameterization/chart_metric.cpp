#include "parameterization/chart_metric.h"

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {

std::vector<TriangleMetric> chart_metric(const PolygonMesh& mesh, const Chart& chart, const SpaceMetric* metric) {
  std::vector<TriangleMetric> result;
  if (metric == nullptr) return result;
  const Positions positions = chart.positions(mesh);
  result.reserve(chart.triangles.size());
  for_each_polled(chart.triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = chart.triangles[t];
    result.push_back(restrict_to_triangle(metric[chart.faces[static_cast<std::size_t>(chart.triangle_face[t])]],
                                          positions.row(a), positions.row(b), positions.row(c)));
  });
  return result;
}

}  // namespace spectral_conformal
