#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// How far the image of a triangle must be from collapsed for its orientation to count. Zero: the sign is exact.
struct FlipTolerance {
  /// Sine of the angle between the first two sides. For maps that are still to be moved, turned or scaled: this rounds
  /// every coordinate anew, and must not turn a thin triangle over.
  double sine = 0;
  /// Height over the longest side, relative to the largest coordinate. For coordinates that were rounded before, to
  /// single precision.
  double resolution = 0;
};

/// The one criterion for the image a b c of a triangle that is counter-clockwise on the surface: 1 where it is
/// counter-clockwise, -1 where it is flipped, 0 where it is collapsed within the tolerance. Finite coordinates.
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

/// The map z (V,), or its mirror image if its signed area is negative: a map that is mirrored as a whole has no flips.
/// triangle_weights (F,) or empty for 1.
ComplexVector positively_oriented(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z);

}  // namespace spectral_conformal
