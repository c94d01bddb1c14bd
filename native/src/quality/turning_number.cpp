#include "quality/turning_number.h"

#include <algorithm>
#include <cmath>

#include "concurrency/cancellation_scope.h"
#include "graph/numbering.h"

namespace spectral_conformal {

int turning_number(const BoundaryLoop& loop, const std::vector<std::array<int, 3>>& triangles,
                   const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& map) {
  // Products of coordinates must neither overflow nor underflow, whatever the unit.
  double extent = 0;
  for (const Complex p : map) extent = std::max({extent, std::abs(p.real()), std::abs(p.imag())});
  if (!(extent > 0)) return 0;
  const ComplexVector z = map / extent;
  const std::vector<int> index_on_loop = indices_in(loop, static_cast<std::size_t>(z.size()));
  std::vector<double> interior(loop.size(), 0);
  std::vector<char> flipped(loop.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int vertex = triangles[t][k];
      const int index = index_on_loop[vertex];
      if (index < 0) continue;
      const Complex next = z[triangles[t][(k + 1) % 3]] - z[vertex];
      const Complex previous = z[triangles[t][(k + 2) % 3]] - z[vertex];
      const double angle = std::arg(std::conj(next) * previous);
      interior[index] += triangle_weights[t] * angle;
      if (angle < 0) flipped[index] = 1;
    }
  }
  poll(triangles.size());
  double turning = 0;
  Complex last = 0;  // the last edge of nonzero length
  for (std::size_t i = loop.size(); i-- > 0 && last == 0.0;) last = z[loop[(i + 1) % loop.size()]] - z[loop[i]];
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Complex edge = z[loop[(i + 1) % loop.size()]] - z[loop[i]];
    if (edge == 0.0) continue;
    const double exterior = std::arg(std::conj(last) * edge);
    // Equal to pi - interior up to full turns, which follow from the triangles unless one is flipped.
    turning += flipped[i] ? exterior : exterior + 2 * pi * std::round((pi - interior[i] - exterior) / (2 * pi));
    last = edge;
  }
  return static_cast<int>(std::lround(turning / (2 * pi)));
}

}  // namespace spectral_conformal
