#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The determinant of two plane vectors, Im(conj(a) b): the signed area of their parallelogram, positive if b lies
/// counterclockwise from a.
inline double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

/// The inner product of two plane vectors, Re(conj(a) b).
inline double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }

/// Signed area of the triangle a b c, positive if counterclockwise.
inline double signed_area(Complex a, Complex b, Complex c) { return 0.5 * cross(b - a, c - a); }

/// Signed area of a map z (V,): the weighted sum over its triangles. triangle_weights: (F,), or empty for 1.
double signed_area(const std::vector<std::array<int, 3>>& triangles,
                   const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z);

}  // namespace spectral_conformal
