#include "relaxation/isometric_relaxation.h"

#include <cmath>

namespace spectral_conformal {
namespace {

struct BestScale {
  double factor = 1;
  double energy = 0;
};

/// c^2 P + Q / c^2 is minimal at c^4 = Q / P.
BestScale best_scale(const std::vector<DistortionElement>& elements, const ComplexVector& z) {
  double p = 0;
  double q = 0;
  double weight = 0;
  for (const DistortionElement& element : elements) {
    const MapJacobian j = jacobian(element, z);
    if (!element.measured || !j.has_area()) continue;
    p += 2 * element.weight * j.half_square;
    q += 2 * element.weight * j.half_square / (j.determinant * j.determinant);
    weight += element.weight;
  }
  if (!(weight > 0)) return {};
  return {std::sqrt(std::sqrt(q / p)), 2 * std::sqrt(p) * std::sqrt(q) / weight};
}

}  // namespace

IsometricMap relax_to_isometry(const std::vector<std::array<int, 3>>& triangles,
                               const std::vector<TriangleShape>& shapes,
                               const std::vector<TriangleWeight>& triangle_weights, std::size_t n_virtual,
                               ComplexVector z, FactorizationBackend backend, const DescentOptions& options,
                               const Progress& progress) {
  report(progress, 0, "relax");
  std::vector<DistortionElement> elements = distortion_elements(triangles, shapes, triangle_weights, n_virtual);
  IsometricMap result;
  result.z = std::move(z);
  result.flipped = count_flipped(elements, result.z);
  const double factor = mean_scale_factor(elements, result.z);
  if (!(factor > 0) || !std::isfinite(factor)) return result;

  ComplexVector relaxed = factor * result.z;
  result.energy_before = best_scale(elements, relaxed).energy;
  const Descent descent = descend(elements, {}, relaxed, backend, options, progress);
  result.iterations = descent.iterations;
  result.factorizations = descent.factorizations;
  const BestScale scale = best_scale(elements, relaxed);
  relaxed *= scale.factor;
  const int flipped = count_flipped(elements, relaxed);
  result.energy = result.energy_before;
  result.status = RelaxationStatus::rejected;
  if (flipped > result.flipped || !relaxed.allFinite()) return result;
  result.status = descent.status;
  result.z = std::move(relaxed);
  result.energy = scale.energy;
  result.flipped = flipped;
  return result;
}

}  // namespace spectral_conformal
