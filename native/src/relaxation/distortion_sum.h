#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "geometry/signed_area.h"
#include "geometry/triangle_shape.h"
#include "linear_algebra/large_pages.h"
#include "relaxation/distortion_energy.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The weighted sum of the distortions of elements as a function of a map z (V,), which a descent lowers.
///
/// Many elements are processed in parts, in several threads; results do not depend on the number of threads.
class DistortionSum {
 public:
  /// elements: of one patch; their weights and regularizations are copied. Elements without weight do not count, except
  /// in max_step.
  static DistortionSum of(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                          Eigen::Index n_vertices);

  DistortionMeasure measure() const { return measure_; }
  void set_measure(DistortionMeasure measure) { measure_ = measure; }
  /// Takes the regularizations of the same elements anew.
  void regularize(const std::vector<DistortionElement>& elements);

  /// The mean of sqrt(c^2 - 1), half of s1 / s2 - s2 / s1; 0 if no triangle counts. Precondition: all that do have
  /// image area.
  double anisotropy(const ComplexVector& z);
  /// The factor that gives the triangles that count and have image area the mean log scale 0; 0 if there are none.
  double mean_scale_factor(const ComplexVector& z);
  /// Infinite if a barrier is crossed; the gradient is then meaningless. Otherwise it is that of the real (2V,) vector,
  /// u + i v.
  double value_and_gradient(const ComplexVector& z, ComplexVector& gradient);
  /// An approximate second derivative along `direction`, nonnegative: DistortionMeasure::stiffness.
  double curvature(const ComplexVector& z, const ComplexVector& direction);
  /// The step along `direction`, at most `limit`, at which the first triangle with image area, however little and
  /// whether it counts or not, loses it.
  double max_step(const ComplexVector& z, const ComplexVector& direction, double limit);

 private:
  struct Triangle {
    std::array<int, 3> corners;  ///< of the part
    double weight;
    double regularization;
    TriangleShape shape;  ///< scaled by 1 / (four times its area), so that its parts of a map are f_z and f_zbar

    /// map: of the part.
    MapJacobian jacobian(const ComplexVector& map) const {
      const auto& [a, b, c] = corners;
      const Complex d1 = map[b] - map[a];
      const Complex d2 = map[c] - map[a];
      MapJacobian j;
      j.holomorphic = shape.holomorphic_part(d1, d2);
      j.antiholomorphic = shape.antiholomorphic_part(d1, d2);
      j.half_square = std::norm(j.holomorphic) + std::norm(j.antiholomorphic);
      // From the edges, not as a difference of squares, so that its sign is that of the image area.
      j.determinant = cross(d1, d2) * (4 * shape.x1 * shape.y2);
      return j;
    }
  };
  /// Neighboring triangles with their own vertices, so that threads share no output and never wait.
  struct Part {
    std::size_t begin = 0;  ///< of its elements
    std::size_t end = 0;
    std::vector<int> vertices;
    LargeVector<Triangle> triangles;
    ComplexVector z;
    ComplexVector other;  ///< a direction, or the gradient
    double sum = 0;
    double weight = 0;

    void gather(const ComplexVector& from, ComplexVector& to) const;
    void sum_up(DistortionMeasure measure);
  };

  DistortionSum() = default;
  template <class Work>
  void for_each_part(const Work& work);
  /// The mean over the triangles that count of value(jacobian), which returns a number, or nothing to leave one out.
  template <class Value>
  std::optional<double> mean(const ComplexVector& z, const Value& value);
  double sum() const;

  std::vector<Part> parts_;
  DistortionMeasure measure_;
};

}  // namespace spectral_conformal
