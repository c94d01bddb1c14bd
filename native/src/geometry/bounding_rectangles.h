#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A rectangle of any direction around points.
struct Rectangle {
  Complex direction = 1;  ///< of length 1, along the side called width
  double width = 0;
  double height = 0;
};

/// The corners of the convex hull, counterclockwise, no three collinear. Collinear points yield the two ends, equal
/// points one corner.
std::vector<Complex> convex_hull(std::vector<Complex> points);

/// The rectangle around a hull with one pair of sides along `direction`, of length 1.
Rectangle bounding_rectangle(const std::vector<Complex>& hull, Complex direction);

/// The rectangles around a hull that have a side on one of its edges, as the smallest has, and at most 1 + `tolerance`
/// times the smallest area. Never empty; width and height may be swapped.
std::vector<Rectangle> smallest_rectangles(const std::vector<Complex>& hull, double tolerance);

}  // namespace spectral_conformal
