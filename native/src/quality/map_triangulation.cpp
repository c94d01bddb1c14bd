#include "quality/map_triangulation.h"

#include <algorithm>

namespace spectral_conformal {

MapTriangulation triangulate_map(const Chart& chart, const ComplexVector& z) {
  const auto area = [&](std::size_t t) {
    const auto& [a, b, c] = chart.triangles[t];
    return std::imag(std::conj(z[b] - z[a]) * (z[c] - z[a]));
  };
  MapTriangulation result;
  result.triangles.reserve(chart.triangles.size());
  result.face.reserve(chart.triangles.size());
  const auto take = [&](std::size_t t) {
    result.triangles.push_back(chart.triangles[t]);
    result.face.push_back(chart.triangle_face[t]);
  };
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    if (chart.triangle_weights[t] == 1.0) {
      take(t);
      continue;
    }
    // triangulate_polygon puts the four triangles of the two splits in a row.
    const auto smaller = [&](std::size_t first) { return std::min(area(first), area(first + 1)); };
    const std::size_t first = smaller(t) >= smaller(t + 2) ? t : t + 2;
    take(first);
    take(first + 1);
    t += 3;
  }
  return result;
}

}  // namespace spectral_conformal
