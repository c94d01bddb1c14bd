#include "relaxation/distortion_energy.h"

#include <algorithm>
#include <limits>

#include "concurrency/listening.h"
#include "geometry/quadratic_roots.h"
#include "geometry/signed_area.h"

namespace spectral_conformal {
namespace {

/// The determinant regularized by DistortionElement::regularization, and its derivative.
struct RegularizedDeterminant {
  double value;
  double slope;
  RegularizedDeterminant(double determinant, double regularization) : value(determinant), slope(1) {
    if (regularization == 0) return;
    if (std::isinf(regularization)) {
      value = infinity;
      slope = 0;
      return;
    }
    const double root = std::hypot(determinant, regularization);
    value = determinant > 0 ? 0.5 * (determinant + root) : 0.5 * regularization * regularization / (root - determinant);
    slope = value / root;
  }
};

/// A distortion and its derivatives with respect to half_square and the determinant.
struct Density {
  double value;
  double by_square;
  double by_determinant;
};

Density density(const DistortionElement& element, DistortionMeasure measure, const MapJacobian& j) {
  const double squares = 2 * j.half_square;  // s1^2 + s2^2
  if (std::isinf(element.regularization)) return {squares, 2, 0};
  // With the determinant D = s1 s2: squares times (1 - sizes) / D + sizes (1 + 1 / D^2).
  const RegularizedDeterminant determinant(j.determinant, element.regularization);
  const double inverse = 1 / determinant.value;
  const double angles = (1 - measure.sizes) * inverse;
  const double areas = measure.sizes * inverse * inverse;
  const double factor = angles + measure.sizes + areas;
  return {squares * factor, 2 * factor, -squares * (angles + 2 * areas) * inverse * determinant.slope};
}

}  // namespace

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

DistortionStiffness stiffness(const DistortionElement& element, DistortionMeasure measure, const MapJacobian& j) {
  // s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 of an isometry.
  const double isometry = DistortionMeasure::symmetric_dirichlet.infimum();
  if (std::isinf(element.regularization)) return {isometry, isometry};
  const double determinant = RegularizedDeterminant(j.determinant, element.regularization).value;
  if (measure.sizes == 0) {
    if (!element.barrier()) {
      const double both = 4 / determinant * (1 + j.half_square / determinant);
      return {both, both};
    }
    // The second derivatives of 2 (a^2 + b^2) / (a^2 - b^2) with respect to a = |f_z| and b = |f_zbar|. The first
    // vanishes for similarities; a fraction of the second, too small to slow the others down, keeps the form definite.
    constexpr double min_fraction = 1e-3;
    const double a = std::norm(j.holomorphic);
    const double b = std::norm(j.antiholomorphic);
    const double cube = determinant * determinant * determinant;
    const double antiholomorphic = 8 * a * (a + 3 * b) / cube;
    return {8 * b * (3 * a + b) / cube + min_fraction * antiholomorphic, antiholomorphic};
  }
  // Any share of sizes: the weight of the symmetric Dirichlet energy bounds that of the conformal distortion too.
  const double larger = std::abs(j.holomorphic) + std::abs(j.antiholomorphic);
  // SLIM's weight (Rabinovich et al. 2017, Table 1): the slope of s^2 + 1 / s^2 over s - 1, halved. The smaller
  // singular value has the larger weight, which majorizes.
  const double inverse = larger / determinant;
  const double local_global = 1 + inverse * (1 + inverse * (1 + inverse));
  // It aims at s = 1 in one step, which would compress the neighbors of very small image triangles until their barriers
  // cut the step short. With this weight such a triangle grows to about 1 + 1 / 0.1 times its size in one step.
  const double growth = 0.1 * (inverse * inverse) * (inverse * inverse);
  const double both = isometry * std::max(local_global, growth);
  return {both, both};
}

double energy_and_gradient(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                           const ComplexVector& z, ComplexVector& gradient) {
  gradient.setZero(z.size());
  double sum = 0;
  for (const DistortionElement& element : elements) {
    const MapJacobian j = jacobian(element, z);
    if (element.barrier() && !(j.determinant > 0)) return infinity;
    const Density f = density(element, measure, j);
    sum += element.weight * f.value;
    const double scale = element.weight / (element.shape.x1 * element.shape.y2);
    const Complex g = scale * (f.by_square + f.by_determinant) * j.holomorphic;
    const Complex h = scale * (f.by_square - f.by_determinant) * j.antiholomorphic;
    element.shape.add_gradient(element.corners, g, h, gradient.data());
  }
  still_working(40 * static_cast<double>(elements.size()));
  return sum;
}

double measured_distortion(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                           const ComplexVector& z) {
  double sum = 0;
  double weight = 0;
  for (DistortionElement element : elements) {
    if (!element.measured) continue;
    const MapJacobian j = jacobian(element, z);
    element.regularization = j.determinant > 0 ? 0 : own_regularization(j);
    sum += element.weight * std::max(density(element, measure, j).value, measure.infimum());
    weight += element.weight;
  }
  still_working(40 * static_cast<double>(elements.size()));
  return weight > 0 ? sum / weight : 0;
}

double image_area(const std::vector<DistortionElement>& elements, const ComplexVector& z) {
  double area = 0;
  for (const DistortionElement& element : elements) {
    const auto& [a, b, c] = element.corners;
    if (!std::isinf(element.regularization)) area += signed_area(z[a], z[b], z[c]);
  }
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
  still_working(20 * static_cast<double>(elements.size()));
}

double max_step(const std::vector<DistortionElement>& elements, const ComplexVector& z,
                const ComplexVector& direction) {
  double largest = infinity;
  for (const DistortionElement& element : elements) {
    const auto& [a, b, c] = element.corners;
    const Complex d1 = z[b] - z[a];
    const Complex d2 = z[c] - z[a];
    if (std::isinf(element.regularization) || !(cross(d1, d2) > 0)) continue;
    const Complex change1 = direction[b] - direction[a];
    const Complex change2 = direction[c] - direction[a];
    const double linear = cross(d1, change2) + cross(change1, d2);
    largest = first_root(cross(d1, d2), linear, cross(change1, change2), largest);
  }
  still_working(40 * static_cast<double>(elements.size()));
  return largest;
}

bool is_flipped(const DistortionElement& element, const ComplexVector& z, const FlipTolerance& tolerance) {
  return element.measured && !is_positive(element.corners, z, tolerance);
}

int count_flipped(const std::vector<DistortionElement>& elements, const ComplexVector& z,
                  const FlipTolerance& tolerance) {
  still_working(40 * static_cast<double>(elements.size()));
  return static_cast<int>(std::count_if(elements.begin(), elements.end(), [&](const DistortionElement& element) {
    return is_flipped(element, z, tolerance);
  }));
}

DistortionElements::DistortionElements(const std::vector<std::array<int, 3>>& triangles,
                                       const std::vector<TriangleShape>& shapes,
                                       const std::vector<TriangleWeight>& triangle_weights, std::size_t n_virtual)
    : triangles_(triangles), shapes_(shapes), triangle_weights_(triangle_weights), n_virtual_(n_virtual) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!shapes[t].clamped) area_ += triangle_weights[t] * shapes[t].area();
  }
}

DistortionElement DistortionElements::operator[](std::size_t t) const {
  // Enough to keep holes from turning inside out, too little to affect the shape of the map.
  constexpr double virtual_weight = 1e-2;
  const TriangleShape& shape = shapes_[t];
  const bool is_virtual = t + n_virtual_ >= size();
  // Rounding leaves hardly any shape of triangles with sides insignificant beside the extent.
  const bool is_degenerate = shape.clamped || !(shape.area() > insignificant * insignificant * area_);
  DistortionElement element{triangles_[t], shape, triangle_weights_[t] * shape.area() / area_,
                            !is_virtual && !is_degenerate};
  if (is_degenerate) element.regularization = infinity;
  if (is_virtual) element.weight *= virtual_weight;
  return element;
}

std::vector<DistortionElement> distortion_elements(const std::vector<std::array<int, 3>>& triangles,
                                                   const std::vector<TriangleShape>& shapes,
                                                   const std::vector<TriangleWeight>& triangle_weights,
                                                   std::size_t n_virtual) {
  const DistortionElements source(triangles, shapes, triangle_weights, n_virtual);
  std::vector<DistortionElement> elements;
  elements.reserve(source.size());
  for_each_heard(source.size(), [&](std::size_t t) { elements.push_back(source[t]); });
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
  still_working(40 * static_cast<double>(elements.size()));
  const auto& [logarithms, weight] = of_others.weight > 0 ? of_others : of_slivers;
  return weight > 0 ? std::exp(-0.5 * logarithms / weight) : 0;
}

}  // namespace spectral_conformal
