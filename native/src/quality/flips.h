#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The distance from collapse beyond which the orientation of a triangle's image counts. Zero: the sign is exact.
struct FlipTolerance {
  /// Sine of the angle between the first two sides. For maps still to be moved, turned or scaled, which rounds every
  /// coordinate anew and must not flip a thin triangle.
  double sine = 0;
  /// Height over the longest side, relative to the largest coordinate. For coordinates already rounded to single
  /// precision.
  double resolution = 0;
};

/// The one flip criterion, for the image a b c of a triangle that is counterclockwise on the surface: 1 if
/// counterclockwise, -1 if flipped, 0 if collapsed within the tolerance. Coordinates must be finite.
int image_orientation(Complex a, Complex b, Complex c, const FlipTolerance& tolerance = {});

/// Whether a triangle of a map z (V,) is flipped.
inline bool is_flipped(const std::array<int, 3>& triangle, const ComplexVector& z,
                       const FlipTolerance& tolerance = {}) {
  return image_orientation(z[triangle[0]], z[triangle[1]], z[triangle[2]], tolerance) < 0;
}

/// Whether a triangle of a map z (V,) is neither flipped nor collapsed.
inline bool is_positive(const std::array<int, 3>& triangle, const ComplexVector& z,
                        const FlipTolerance& tolerance = {}) {
  return image_orientation(z[triangle[0]], z[triangle[1]], z[triangle[2]], tolerance) > 0;
}

/// The triangles, ascending, that are flipped or collapsed.
std::vector<int> non_positive_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& z,
                                        const FlipTolerance& tolerance = {});

/// The map z (V,), or its mirror image if its signed area is negative: a map mirrored as a whole has no flips.
/// triangle_weights (F,) or empty for 1.
ComplexVector positively_oriented(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z);

}  // namespace spectral_conformal
