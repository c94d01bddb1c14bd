#pragma once

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The orientation of the triangle a b c: 1 counter-clockwise, -1 clockwise, 0 where the points lie on one line. Exact
/// for finite coordinates, whatever rounding does to the area (CGAL's filtered predicate).
int orientation(Complex a, Complex b, Complex c);

}  // namespace spectral_conformal
