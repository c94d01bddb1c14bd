#pragma once

#include <cmath>
#include <limits>

#include "geometry/tolerances.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The orientation of the triangle a b c, without the filter of orientation(): CGAL's exact predicate. Throws
/// SolveFailure for coordinates that are not finite.
int exact_orientation(Complex a, Complex b, Complex c);

/// The lexicographic order of points: left before right, and at the same place below before above.
inline bool is_left_of(Complex p, Complex q) {
  return p.real() != q.real() ? p.real() < q.real() : p.imag() < q.imag();
}

/// The orientation of the triangle a b c: 1 counterclockwise, -1 clockwise, 0 where the points lie on one line. Exact,
/// regardless of rounding. Throws SolveFailure for coordinates that are not finite.
inline int orientation(Complex a, Complex b, Complex c) {
  // Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates" (1997), bound A:
  // a determinant above (3 + 16 u) u of the sum of its terms, u = epsilon / 2, has the right sign.
  const double left = (a.real() - c.real()) * (b.imag() - c.imag());
  const double right = (a.imag() - c.imag()) * (b.real() - c.real());
  const double terms = std::abs(left) + std::abs(right);
  const double determinant = left - right;
  // Smaller terms may lose digits to underflow, which the bound does not cover.
  const bool has_digits = terms > std::numeric_limits<double>::min() / epsilon;
  if (std::abs(determinant) > (3 + 8 * epsilon) * (epsilon / 2) * terms && has_digits) return determinant > 0 ? 1 : -1;
  return exact_orientation(a, b, c);
}

}  // namespace spectral_conformal
