#include "quality/flips.h"

#include <algorithm>
#include <cmath>

#include "concurrency/cancellation_scope.h"
#include "geometry/orientation.h"
#include "geometry/signed_area.h"

namespace spectral_conformal {

int image_orientation(Complex a, Complex b, Complex c, const FlipTolerance& tolerance) {
  if (tolerance.sine == 0 && tolerance.resolution == 0) return orientation(a, b, c);
  const std::array<double, 3> length{modulus(b - a), modulus(c - b), modulus(a - c)};
  double collapsed = tolerance.sine * length[0] * length[2];
  if (tolerance.resolution > 0) {
    double largest = 0;
    for (const Complex p : {a, b, c}) largest = std::max({largest, std::abs(p.real()), std::abs(p.imag())});
    collapsed += tolerance.resolution * largest * std::max({length[0], length[1], length[2]});
  }
  const double twice_area = cross(b - a, c - a);
  if (twice_area > collapsed) return 1;
  return twice_area < -collapsed ? -1 : 0;
}

std::vector<int> non_positive_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& z,
                                        const FlipTolerance& tolerance) {
  std::vector<int> result;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!is_positive(triangles[t], z, tolerance)) result.push_back(static_cast<int>(t));
  }
  poll(triangles.size());
  return result;
}

ComplexVector positively_oriented(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z) {
  return signed_area(triangles, triangle_weights, z) < 0 ? ComplexVector(z.conjugate()) : z;
}

}  // namespace spectral_conformal
