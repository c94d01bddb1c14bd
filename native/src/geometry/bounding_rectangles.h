#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A rectangle around points, of any direction.
struct Rectangle {
  Complex direction = 1;  ///< of length 1, along the side called width
  double width = 0;
  double height = 0;
};

/// The convex hull's corners, counter-clockwise, no three in a line; of points in a line the two ends, of equal points
/// one.
std::vector<Complex> convex_hull(std::vector<Complex> points);

/// The rectangle around a hull with one pair of sides along `direction`, of length 1.
Rectangle bounding_rectangle(const std::vector<Complex>& hull, Complex direction);

/// The rectangles around a hull that have a side on one of its edges, as the smallest has, and whose area is that of
/// the smallest times at most 1 + `tolerance`. Never empty; width and height may be swapped.
std::vector<Rectangle> smallest_rectangles(const std::vector<Complex>& hull, double tolerance);

}  // namespace spectral_conformal
