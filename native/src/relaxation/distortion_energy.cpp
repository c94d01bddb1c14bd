#include "relaxation/distortion_energy.h"

#include <algorithm>
#include <limits>

#include "concurrency/cancellation_scope.h"
#include "geometry/signed_area.h"

namespace spectral_conformal {
MapJacobian jacobian(const DistortionElement& element, const ComplexVector& z) {
  const auto& [a, b, c] = element.corners;
  const Complex d1 = z[b] - z[a];
  const Complex d2 = z[c] - z[a];
  const double double_area = element.shape.x1 * element.shape.y2;
  MapJacobian j;
  j.holomorphic = element.shape.holomorphic_part(d1, d2) / (2 * double_area);
  j.antiholomorphic = element.shape.antiholomorphic_part(d1, d2) / (2 * double_area);
  j.half_square = std::norm(j.holomorphic) + std::norm(j.antiholomorphic);
  // From the edges, not as a difference of squares, so that its sign is that of the image area.
  j.determinant = cross(d1, d2) / double_area;
  return j;
}

double measured_distortion(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                           const ComplexVector& z) {
  double sum = 0;
  double weight = 0;
  for (DistortionElement element : elements) {
    if (!element.measured) continue;
    const MapJacobian j = jacobian(element, z);
    element.regularization = j.determinant > 0 ? 0 : own_regularization(j);
    sum += element.weight * std::max(measure.density(element.regularization, j).value, measure.infimum());
    weight += element.weight;
  }
  poll(elements.size());
  return weight > 0 ? sum / weight : 0;
}

double image_area(const std::vector<DistortionElement>& elements, const ComplexVector& z) {
  double area = 0;
  for (const DistortionElement& element : elements) {
    const auto& [a, b, c] = element.corners;
    if (!std::isinf(element.regularization)) area += signed_area(z[a], z[b], z[c]);
  }
  poll(elements.size());
  return area;
}

void add_image_area_gradient(const std::vector<DistortionElement>& elements, const ComplexVector& z, double factor,
                             ComplexVector& gradient) {
  const Complex half(0, 0.5 * factor);
  for (const DistortionElement& element : elements) {
    if (std::isinf(element.regularization)) continue;
    const auto& [a, b, c] = element.corners;
    gradient[a] += half * (z[c] - z[b]);
    gradient[b] += half * (z[a] - z[c]);
    gradient[c] += half * (z[b] - z[a]);
  }
  poll(elements.size());
}

bool is_flipped(const DistortionElement& element, const ComplexVector& z, const FlipTolerance& tolerance) {
  return element.measured && !is_positive(element.corners, z, tolerance);
}

int count_flipped(const std::vector<DistortionElement>& elements, const ComplexVector& z,
                  const FlipTolerance& tolerance) {
  poll(elements.size());
  return static_cast<int>(std::count_if(elements.begin(), elements.end(), [&](const DistortionElement& element) {
    return is_flipped(element, z, tolerance);
  }));
}

std::vector<DistortionElement> distortion_elements(const std::vector<std::array<int, 3>>& triangles,
                                                   const std::vector<TriangleShape>& shapes,
                                                   const std::vector<TriangleWeight>& triangle_weights,
                                                   std::size_t n_virtual) {
  // Enough to keep holes from turning inside out, too little to affect the shape of the map.
  constexpr double virtual_weight = 1e-2;
  double area = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!shapes[t].clamped) area += triangle_weights[t] * shapes[t].area();
  }
  std::vector<DistortionElement> elements;
  elements.reserve(triangles.size());
  for_each_polled(triangles.size(), [&](std::size_t t) {
    const bool is_virtual = t + n_virtual >= triangles.size();
    // Rounding leaves hardly any shape of triangles with sides insignificant beside the extent.
    const bool is_degenerate = shapes[t].clamped || !(shapes[t].area() > insignificant * insignificant * area);
    DistortionElement element{triangles[t], shapes[t], triangle_weights[t] * shapes[t].area() / area,
                              !is_virtual && !is_degenerate};
    if (is_degenerate) element.regularization = infinity;
    if (is_virtual) element.weight *= virtual_weight;
    elements.push_back(element);
  });
  return elements;
}

double mean_scale_factor(const std::vector<DistortionElement>& elements, const ComplexVector& z) {
  struct Sum {
    double logarithms = 0;
    double weight = 0;
  };
  Sum of_slivers;
  Sum of_others;
  for (const DistortionElement& element : elements) {
    const MapJacobian j = jacobian(element, z);
    if (!element.measured || !(j.determinant > 0)) continue;
    Sum& sum = j.is_sliver() ? of_slivers : of_others;
    sum.logarithms += element.weight * std::log(j.determinant);
    sum.weight += element.weight;
  }
  poll(elements.size());
  const auto& [logarithms, weight] = of_others.weight > 0 ? of_others : of_slivers;
  return weight > 0 ? std::exp(-0.5 * logarithms / weight) : 0;
}

}  // namespace spectral_conformal
