#pragma once

#include <array>
#include <vector>

#include "conformal/conformal_energy.h"
#include "geometry/triangle_shape.h"
#include "linear_algebra/large_pages.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The mean of the quasi-conformal distortion QC = s1 / s2 of a patch's triangles, by area in 3D; s1 >= s2 are the
/// singular values of a triangle's Jacobian. With c = (s1 / s2 + s2 / s1) / 2 it is c + sqrt(c^2 - 1), which has a kink
/// at similarities; smoothed, c + sqrt(c^2 - 1 + smoothing^2). Filled holes count a hundredth of their area. Triangles
/// that are flipped or slivers in the first map, or have no area in 3D, do not count.
///
/// Large patches are gone through in parts, in several threads at once; what comes out does not depend on how many.
class MeanDistortion {
 public:
  /// z (V,) finite, virtual vertices included: the first map. relative_smoothing: over the mean of sqrt(c^2 - 1) in it.
  MeanDistortion(const ConformalEnergy& energy, const ComplexVector& z, double relative_smoothing);

  /// The mean of sqrt(c^2 - 1), half of s1 / s2 - s2 / s1, in the first map; 0 where no triangle counts.
  double anisotropy() const { return anisotropy_; }

  /// Infinite where a triangle that counts has no image area or is flipped; the gradient is then of no use. Otherwise
  /// it is that of the real (2V,) vector, u + i v.
  double value_and_gradient(const ComplexVector& z, ComplexVector& gradient);
  /// A second derivative along `direction` that is not negative: see DistortionMeasure::conformal, whose stiffness is
  /// taken times the slope of this distortion over that one.
  double curvature(const ComplexVector& z, const ComplexVector& direction);
  /// The step along `direction`, `limit` at most, at which the first triangle with image area loses it, whether it
  /// counts or not.
  double max_step(const ComplexVector& z, const ComplexVector& direction, double limit);

 private:
  struct Triangle {
    std::array<int, 3> corners;  ///< of the part
    double weight;               ///< 0 where it does not count
    TriangleShape shape;         ///< over four times its area: its parts of a map are then f_z and f_zbar
  };
  /// Neighboring triangles with their own vertices, so that threads neither share what they write nor wait.
  struct Part {
    std::vector<int> vertices;
    LargeVector<Triangle> triangles;
    ComplexVector z;
    ComplexVector other;  ///< a direction, or the gradient
    double sum = 0;
    double weight = 0;
  };

  template <class Work>
  void for_each_part(const Work& work);
  static void gather(const Part& part, const ComplexVector& from, ComplexVector& to);
  static double sum_up(Part& part, double squared_smoothing);

  std::vector<Part> parts_;
  double anisotropy_ = 0;
  double squared_smoothing_ = 0;
};

}  // namespace spectral_conformal
