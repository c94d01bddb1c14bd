#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/triangle_shape.h"
#include "quality/flips.h"
#include "relaxation/distortion_measure.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

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

/// The elements of a patch, weighted by triangle weight times area as a fraction of the whole. Degenerate triangles get
/// an infinite regularization; the last `n_virtual` triangles (see hole_filling.h) a hundredth of their weight. shapes
/// and triangle_weights: per triangle.
std::vector<DistortionElement> distortion_elements(const std::vector<std::array<int, 3>>& triangles,
                                                   const std::vector<TriangleShape>& shapes,
                                                   const std::vector<TriangleWeight>& triangle_weights,
                                                   std::size_t n_virtual);

MapJacobian jacobian(const DistortionElement& element, const ComplexVector& z);

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
