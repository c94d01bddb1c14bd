#include "layout/placement.h"

#include <cmath>

#include "concurrency/cancellation_scope.h"
#include "geometry/signed_area.h"
#include "layout/upright.h"

namespace spectral_conformal {

double signed_area(const ConformalEnergy& energy, const ComplexVector& z) {
  double area = 0;
  const auto& triangles = energy.triangles();
  for (std::size_t t = 0; t + energy.n_virtual() < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    area += energy.triangle_weights()[t] * signed_area(z[a], z[b], z[c]);
  }
  poll(triangles.size());
  return area;
}

bool place(ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
           const Eigen::Ref<const Positions>& positions, double area) {
  const double unscaled = signed_area(energy, z);
  if (!(unscaled > 0) || !std::isfinite(unscaled)) return false;
  z.array() -= z.mean();
  z *= upright_turn(z, energy, outer_loop, positions) * std::sqrt(area / unscaled);
  return true;
}

}  // namespace spectral_conformal
