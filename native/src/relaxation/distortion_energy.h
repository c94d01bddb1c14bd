#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/tolerances.h"
#include "geometry/triangle_shape.h"
#include "quality/flips.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The distortion of a triangle as a function of the singular values s1 and s2 of its Jacobian,
///   (1 - sizes) (s1 / s2 + s2 / s1) + sizes (s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2),
/// a blend of the conformal distortion, which any similarity minimizes (Hormann and Greiner, MIPS: An Efficient Global
/// Parametrization Method, 2000), and the symmetric Dirichlet energy, which only an isometry minimizes (Smith and
/// Schaefer, Bijective Parameterization with Free Boundaries, 2015). Unbounded as a triangle loses its image area.
struct DistortionMeasure {
  double sizes = 1;  ///< from 0, angles alone, to 1

  double infimum() const { return 2 + 2 * sizes; }

  static const DistortionMeasure symmetric_dirichlet;
  static const DistortionMeasure conformal;
};
inline constexpr DistortionMeasure DistortionMeasure::symmetric_dirichlet{1};
inline constexpr DistortionMeasure DistortionMeasure::conformal{0};

/// One triangle in a distortion energy.
struct DistortionElement {
  std::array<int, 3> corners{};
  TriangleShape shape;
  double weight = 0;
  bool measured = true;  ///< whether its distortion and flips count; false for virtual and degenerate triangles
  /// The determinant regularization e. 0: a barrier keeps the determinant positive. Otherwise the determinant is
  /// replaced by (det + sqrt(det^2 + e^2)) / 2, which is positive everywhere (Garanzha, Kaporin, Kudryavtseva, Protais,
  /// Ray and Sokolov, Foldover-Free Maps in 50 Lines of Code, 2021). Infinite: only s1^2 + s2^2 counts, whatever the
  /// measure, so that degenerate triangles keep their vertices together.
  double regularization = 0;

  bool barrier() const { return regularization == 0; }
  bool without_area() const { return regularization > 0 && std::isfinite(regularization); }
};

/// f_z and f_zbar of a triangle's image, half the squared norm |f_z|^2 + |f_zbar|^2 and the determinant
/// |f_z|^2 - |f_zbar|^2.
struct MapJacobian {
  Complex holomorphic;
  Complex antiholomorphic;
  double half_square;
  double determinant;
  bool is_sliver() const { return !(determinant > sliver * half_square); }
  /// The barrier of a sliver, or of an image of insignificant scale, would dominate the energy of all other triangles.
  /// Of the image scaled by a factor.
  MapJacobian scaled(double factor) const {
    const double square = factor * factor;
    return {factor * holomorphic, factor * antiholomorphic, square * half_square, square * determinant};
  }
  bool has_area() const { return !is_sliver() && determinant > insignificant * insignificant; }
};

/// The elements of a patch, made one by one, weighted by triangle weight times area as a fraction of the whole.
/// Degenerate triangles get an infinite regularization; the last `n_virtual` triangles (see hole_filling.h) a hundredth
/// of their weight. shapes and triangle_weights: per triangle; all must outlive this object.
class DistortionElements {
 public:
  DistortionElements(const std::vector<std::array<int, 3>>& triangles, const std::vector<TriangleShape>& shapes,
                     const std::vector<TriangleWeight>& triangle_weights, std::size_t n_virtual);
  std::size_t size() const { return triangles_.size(); }
  DistortionElement operator[](std::size_t t) const;

 private:
  const std::vector<std::array<int, 3>>& triangles_;
  const std::vector<TriangleShape>& shapes_;
  const std::vector<TriangleWeight>& triangle_weights_;
  std::size_t n_virtual_;
  double area_ = 0;
};

/// All of them.
std::vector<DistortionElement> distortion_elements(const std::vector<std::array<int, 3>>& triangles,
                                                   const std::vector<TriangleShape>& shapes,
                                                   const std::vector<TriangleWeight>& triangle_weights,
                                                   std::size_t n_virtual);

MapJacobian jacobian(const DistortionElement& element, const ComplexVector& z);

/// A quadratic form weight (holomorphic |f_z|^2 + antiholomorphic |f_zbar|^2) of one triangle, the weight left out.
struct DistortionStiffness {
  double holomorphic;
  double antiholomorphic;
};

/// A positive definite form that approximates the Hessian of the triangle's distortion.
DistortionStiffness stiffness(const DistortionElement& element, DistortionMeasure measure, const MapJacobian& j);

/// The weighted sum of the elements' distortions, infinite if a barrier is crossed. The gradient is that of the real
/// (2V,) vector, u + i v. z: (V,).
double energy_and_gradient(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                           const ComplexVector& z, ComplexVector& gradient);

/// The weighted mean of the measured elements' distortions, whatever their barriers: elements without image area have a
/// finite one, of their own size and at least the infimum. 0 if none is measured. z: (V,).
double measured_distortion(const std::vector<DistortionElement>& elements, DistortionMeasure measure,
                           const ComplexVector& z);

/// The signed image area of the elements, in units of z squared, without those of infinite regularization.
double image_area(const std::vector<DistortionElement>& elements, const ComplexVector& z);

/// Adds `factor` times its gradient, likewise.
void add_image_area_gradient(const std::vector<DistortionElement>& elements, const ComplexVector& z, double factor,
                             ComplexVector& gradient);

/// The regularization of an element without image area, in proportion to its size. Collapsed ones have a hundredth of
/// the mean scale, which is about 1.
inline double own_regularization(const MapJacobian& j) { return std::max(j.half_square, 1e-2); }

/// The step along `direction` at which the first triangle with image area, however little, loses it; infinite if none
/// does.
double max_step(const std::vector<DistortionElement>& elements, const ComplexVector& z, const ComplexVector& direction);

/// The factor that gives the measured elements the mean log scale 0: those that are no slivers or, as in an embedding
/// of a long ribbon, all if all are; 0 if none has image area.
double mean_scale_factor(const std::vector<DistortionElement>& elements, const ComplexVector& z);

/// For maps not yet placed: turning and scaling will round their coordinates. Sines of this size, a thousand times
/// rounding, survive that.
constexpr FlipTolerance unplaced{1e-13, 0};

/// Whether an element is measured and flipped or collapsed.
bool is_flipped(const DistortionElement& element, const ComplexVector& z, const FlipTolerance& tolerance = {});

/// The number of such elements.
int count_flipped(const std::vector<DistortionElement>& elements, const ComplexVector& z,
                  const FlipTolerance& tolerance = {});

}  // namespace spectral_conformal
