#include "relaxation/distortion_sum.h"

#include <algorithm>
#include <cmath>

#include "concurrency/parallel_calls.h"
#include "geometry/quadratic_roots.h"
#include "geometry/signed_area.h"

namespace spectral_conformal {

template <class Work>
void DistortionSum::for_each_part(const Work& work) {
  const auto work_on = [&](int p, const Progress&) {
    work(parts_[p]);
    poll(parts_[p].triangles.size());
  };
  if (parts_.size() == 1) return work_on(0, {});
  run_in_parallel(static_cast<int>(parts_.size()), work_on, {}, "");
}

DistortionSum DistortionSum::of(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                                Eigen::Index n_vertices) {
  DistortionSum result;
  result.measure_ = measure;
  const std::size_t n_parts = std::clamp(elements.size() / shared_steps, std::size_t{1}, std::size_t{max_shares});
  result.parts_.resize(n_parts);
  for (std::size_t p = 0; p < n_parts; ++p) {
    result.parts_[p].begin = p * elements.size() / n_parts;
    result.parts_[p].end = (p + 1) * elements.size() / n_parts;
  }
  result.for_each_part([&](Part& part) {
    std::vector<int> index(static_cast<std::size_t>(n_vertices), -1);
    part.triangles.reserve(part.end - part.begin);
    for (std::size_t t = part.begin; t < part.end; ++t) {
      const auto& [corners, shape, weight, measured, regularization] = elements[t];
      Triangle triangle{{}, weight, regularization, shape.scaled(1 / (2 * shape.x1 * shape.y2))};
      for (std::size_t k = 0; k < 3; ++k) {
        int& own = index[static_cast<std::size_t>(corners[k])];
        if (own < 0) {
          own = static_cast<int>(part.vertices.size());
          part.vertices.push_back(corners[k]);
        }
        triangle.corners[k] = own;
      }
      part.triangles.push_back(triangle);
    }
  });
  return result;
}

void DistortionSum::Part::gather(const ComplexVector& from, ComplexVector& to) const {
  to.resize(static_cast<Eigen::Index>(vertices.size()));
  for (Eigen::Index i = 0; i < to.size(); ++i) to[i] = from[vertices[static_cast<std::size_t>(i)]];
}

void DistortionSum::Part::sum_up(DistortionMeasure measure) {
  sum = 0;
  for (const Triangle& triangle : triangles) {
    if (triangle.weight == 0) continue;
    const MapJacobian j = triangle.jacobian(z);
    if (triangle.regularization == 0 && !(j.determinant > 0)) {
      sum = infinity;
      return;
    }
    const DistortionMeasure::Density f = measure.density(triangle.regularization, j);
    sum += triangle.weight * f.value;
    const double by_square = 2 * triangle.weight * f.by_square;
    const double by_determinant = 2 * triangle.weight * f.by_determinant;
    const Complex g = (by_square + by_determinant) * j.holomorphic;
    const Complex h = (by_square - by_determinant) * j.antiholomorphic;
    triangle.shape.add_gradient(triangle.corners, g, h, other.data());
  }
}

void DistortionSum::regularize(const std::vector<DistortionElement>& elements) {
  for_each_part([&](Part& part) {
    for (std::size_t t = part.begin; t < part.end; ++t) {
      part.triangles[t - part.begin].regularization = elements[t].regularization;
    }
  });
}

double DistortionSum::sum() const {
  double sum = 0;
  for (const Part& part : parts_) sum += part.sum;
  return sum;
}

template <class Value>
std::optional<double> DistortionSum::mean(const ComplexVector& z, const Value& value) {
  for_each_part([&](Part& part) {
    part.gather(z, part.z);
    part.sum = part.weight = 0;
    for (const Triangle& triangle : part.triangles) {
      if (triangle.weight == 0) continue;
      const std::optional<double> its_value = value(triangle.jacobian(part.z));
      if (!its_value) continue;
      part.sum += triangle.weight * *its_value;
      part.weight += triangle.weight;
    }
  });
  double weight = 0;
  for (const Part& part : parts_) weight += part.weight;
  return weight > 0 ? std::optional(sum() / weight) : std::nullopt;
}

double DistortionSum::anisotropy(const ComplexVector& z) {
  const auto of_triangle = [](const MapJacobian& j) -> std::optional<double> {
    return DistortionMeasure::smoothed_root(j, 1 / j.determinant, 0);
  };
  return mean(z, of_triangle).value_or(0);
}

double DistortionSum::mean_scale_factor(const ComplexVector& z) {
  const auto log_area = [](const MapJacobian& j) {
    return j.determinant > 0 ? std::optional(std::log(j.determinant)) : std::nullopt;
  };
  const std::optional<double> logarithm = mean(z, log_area);
  return logarithm ? std::exp(-0.5 * *logarithm) : 0;
}

double DistortionSum::value_and_gradient(const ComplexVector& z, ComplexVector& gradient) {
  for_each_part([&](Part& part) {
    part.gather(z, part.z);
    part.other.setZero(part.z.size());
    part.sum_up(measure_);
  });
  gradient.setZero(z.size());
  for (const Part& part : parts_) {
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      gradient[part.vertices[i]] += part.other[static_cast<Eigen::Index>(i)];
    }
  }
  return sum();
}

double DistortionSum::curvature(const ComplexVector& z, const ComplexVector& direction) {
  for_each_part([&](Part& part) {
    part.gather(z, part.z);
    part.gather(direction, part.other);
    part.sum = 0;
    for (const Triangle& triangle : part.triangles) {
      if (triangle.weight == 0) continue;
      const DistortionStiffness form = measure_.stiffness(triangle.regularization, triangle.jacobian(part.z));
      const MapJacobian change = triangle.jacobian(part.other);
      part.sum += triangle.weight * (form.holomorphic * std::norm(change.holomorphic) +
                                     form.antiholomorphic * std::norm(change.antiholomorphic));
    }
  });
  return sum();
}

double DistortionSum::max_step(const ComplexVector& z, const ComplexVector& direction, double limit) {
  for_each_part([&](Part& part) {
    part.gather(z, part.z);
    part.gather(direction, part.other);
    double step = limit;
    for (const Triangle& triangle : part.triangles) {
      if (std::isinf(triangle.regularization)) continue;
      const auto& [a, b, c] = triangle.corners;
      const Complex d1 = part.z[b] - part.z[a];
      const Complex d2 = part.z[c] - part.z[a];
      const double area = cross(d1, d2);
      if (!(area > 0)) continue;
      const Complex change1 = part.other[b] - part.other[a];
      const Complex change2 = part.other[c] - part.other[a];
      step = first_root(area, cross(d1, change2) + cross(change1, d2), cross(change1, change2), step);
    }
    part.sum = step;
  });
  double step = limit;
  for (const Part& part : parts_) step = std::min(step, part.sum);
  return step;
}

}  // namespace spectral_conformal
