#include "relaxation/mean_distortion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "concurrency/listening.h"
#include "concurrency/parallel_calls.h"
#include "geometry/quadratic_roots.h"
#include "geometry/signed_area.h"
#include "relaxation/distortion_energy.h"

namespace spectral_conformal {
namespace {

/// f_z, f_zbar and the determinant |f_z|^2 - |f_zbar|^2 of a triangle's image.
struct Image {
  Complex holomorphic;
  Complex antiholomorphic;
  double determinant;
  /// shape: scaled by 1 / (four times its area).
  Image(const TriangleShape& shape, Complex d1, Complex d2)
      : holomorphic(shape.holomorphic_part(d1, d2)),
        antiholomorphic(shape.antiholomorphic_part(d1, d2)),
        // From the edges, not as a difference of squares, so that its sign is that of the image area.
        determinant(cross(d1, d2) * (4 * shape.x1 * shape.y2)) {}
};

/// The numbers per triangle that enter the sums.
struct Distorted {
  double c;     ///< (s1 / s2 + s2 / s1) / 2
  double root;  ///< sqrt(c^2 - 1 + smoothing^2), without cancellation near similarities
  Distorted(const Image& image, double inverse_determinant, double squared_smoothing) {
    const double p = std::norm(image.holomorphic) * inverse_determinant;
    const double q = std::norm(image.antiholomorphic) * inverse_determinant;
    c = p + q;
    root = std::sqrt(4 * p * q + squared_smoothing);
  }
};

}  // namespace

template <class Work>
void MeanDistortion::for_each_part(const Work& work) {
  const auto n = static_cast<int>(parts_.size());
  if (n == 1) {
    work(parts_.front());
    return;
  }
  const double nanoseconds = element_nanoseconds * static_cast<double>(parts_.front().triangles.capacity());
  run_in_parallel(
      n,
      [&](int i, const Progress&) {
        work(parts_[static_cast<std::size_t>(i)]);
        still_working(nanoseconds);
      },
      {}, "");
}

MeanDistortion MeanDistortion::of(const ConformalEnergy& energy, const ComplexVector& z, double relative_smoothing) {
  MeanDistortion result;
  const DistortionElements elements(energy.triangles(), energy.energy_shapes(), energy.triangle_weights(),
                                    energy.n_virtual());
  const double work = element_nanoseconds * static_cast<double>(elements.size());
  const std::size_t n_parts =
      std::clamp(static_cast<std::size_t>(work / shared_nanoseconds), std::size_t{1}, std::size_t{max_shares});
  result.parts_.resize(n_parts);
  result.for_each_part([&](Part& part) {
    const auto p = static_cast<std::size_t>(&part - result.parts_.data());
    std::vector<int> index(static_cast<std::size_t>(z.size()), -1);
    part.triangles.reserve((elements.size() + n_parts - 1) / n_parts);
    const std::size_t end = (p + 1) * elements.size() / n_parts;
    for (std::size_t t = p * elements.size() / n_parts; t < end; ++t) {
      const DistortionElement element = elements[t];
      if (!element.barrier()) continue;
      const MapJacobian j = jacobian(element, z);
      const double scale = 1 / (2 * element.shape.x1 * element.shape.y2);
      Triangle triangle;
      triangle.weight = j.is_sliver() ? 0 : element.weight;
      triangle.shape = element.shape.scaled(scale);
      for (std::size_t k = 0; k < 3; ++k) {
        int& own = index[static_cast<std::size_t>(element.corners[k])];
        if (own < 0) {
          own = static_cast<int>(part.vertices.size());
          part.vertices.push_back(element.corners[k]);
        }
        triangle.corners[k] = own;
      }
      part.triangles.push_back(triangle);
    }
    gather(part, z, part.z);
    for (const Triangle& triangle : part.triangles) {
      if (triangle.weight == 0) continue;
      const auto& [a, b, c] = triangle.corners;
      const Image image(triangle.shape, part.z[b] - part.z[a], part.z[c] - part.z[a]);
      part.sum += triangle.weight * Distorted(image, 1 / image.determinant, 0).root;
      part.weight += triangle.weight;
    }
  });
  double sum = 0;
  double weight = 0;
  for (const Part& part : result.parts_) {
    sum += part.sum;
    weight += part.weight;
  }
  if (weight > 0) result.anisotropy_ = sum / weight;
  result.squared_smoothing_ = relative_smoothing * result.anisotropy_ * relative_smoothing * result.anisotropy_;
  return result;
}

void MeanDistortion::gather(const Part& part, const ComplexVector& from, ComplexVector& to) {
  to.resize(static_cast<Eigen::Index>(part.vertices.size()));
  for (Eigen::Index i = 0; i < to.size(); ++i) to[i] = from[part.vertices[static_cast<std::size_t>(i)]];
}

double MeanDistortion::sum_up(Part& part, double squared_smoothing) {
  const Complex* const z = part.z.data();
  Complex* const gradient = part.other.data();
  double sum = 0;
  for (const Triangle& triangle : part.triangles) {
    if (triangle.weight == 0) continue;
    const auto& [a, b, c] = triangle.corners;
    const Image image(triangle.shape, z[b] - z[a], z[c] - z[a]);
    if (!(image.determinant > 0)) return infinity;
    const double inverse = 1 / image.determinant;
    const Distorted distorted(image, inverse, squared_smoothing);
    sum += triangle.weight * (distorted.c + distorted.root);
    const double by_square = 2 * triangle.weight * (1 + distorted.c / distorted.root) * inverse;
    const double by_determinant = -by_square * distorted.c;
    const Complex g = (by_square + by_determinant) * image.holomorphic;
    const Complex h = (by_square - by_determinant) * image.antiholomorphic;
    triangle.shape.add_gradient(triangle.corners, g, h, gradient);
  }
  return sum;
}

double MeanDistortion::value_and_gradient(const ComplexVector& z, ComplexVector& gradient) {
  for_each_part([&](Part& part) {
    gather(part, z, part.z);
    part.other.setZero(part.z.size());
    part.sum = sum_up(part, squared_smoothing_);
  });
  gradient.setZero(z.size());
  double sum = 0;
  for (const Part& part : parts_) {
    sum += part.sum;
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      gradient[part.vertices[i]] += part.other[static_cast<Eigen::Index>(i)];
    }
  }
  return sum;
}

double MeanDistortion::curvature(const ComplexVector& z, const ComplexVector& direction) {
  for_each_part([&](Part& part) {
    gather(part, z, part.z);
    gather(part, direction, part.other);
    part.sum = 0;
    for (const Triangle& triangle : part.triangles) {
      if (triangle.weight == 0) continue;
      const auto& [a, b, c] = triangle.corners;
      const Image image(triangle.shape, part.z[b] - part.z[a], part.z[c] - part.z[a]);
      const Image change(triangle.shape, part.other[b] - part.other[a], part.other[c] - part.other[a]);
      MapJacobian j{};
      j.holomorphic = image.holomorphic;
      j.antiholomorphic = image.antiholomorphic;
      j.half_square = std::norm(j.holomorphic) + std::norm(j.antiholomorphic);
      j.determinant = image.determinant;
      const DistortionStiffness conformal = stiffness({}, DistortionMeasure::conformal, j);
      const Distorted distorted(image, 1 / image.determinant, squared_smoothing_);
      // Scale by the slope of this distortion over the conformal one, 2 c.
      const double slope = 0.5 * (1 + distorted.c / distorted.root);
      part.sum += triangle.weight * slope *
                  (conformal.holomorphic * std::norm(change.holomorphic) +
                   conformal.antiholomorphic * std::norm(change.antiholomorphic));
    }
  });
  double sum = 0;
  for (const Part& part : parts_) sum += part.sum;
  return sum;
}

double MeanDistortion::max_step(const ComplexVector& z, const ComplexVector& direction, double limit) {
  for_each_part([&](Part& part) {
    gather(part, z, part.z);
    gather(part, direction, part.other);
    double step = limit;
    for (const Triangle& triangle : part.triangles) {
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
