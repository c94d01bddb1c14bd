#include "geometry/signed_area.h"

namespace spectral_conformal {

double signed_area(const std::vector<std::array<int, 3>>& triangles,
                   const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z) {
  double area = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    area += (triangle_weights.empty() ? 1.0 : triangle_weights[t]) * signed_area(z[a], z[b], z[c]);
  }
  return area;
}

}  // namespace spectral_conformal
