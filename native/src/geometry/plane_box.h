#pragma once

#include <array>
#include <initializer_list>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A closed axis-aligned rectangle; empty by default.
struct PlaneBox {
  std::array<double, 2> low{infinity, infinity};
  std::array<double, 2> high{-infinity, -infinity};

  bool meets(const PlaneBox& other) const {
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] && other.low[1] <= high[1];
  }
  void include(const PlaneBox& other);
  void include(Complex point);

  Complex low_corner() const { return {low[0], low[1]}; }
  Complex high_corner() const { return {high[0], high[1]}; }
  Complex middle() const { return 0.5 * (low_corner() + high_corner()); }
  Complex size() const { return high_corner() - low_corner(); }  ///< width and height

  /// The bounding box of points.
  static PlaneBox of(std::initializer_list<Complex> points);
  static PlaneBox of(const std::vector<Complex>& points);
};

}  // namespace spectral_conformal
