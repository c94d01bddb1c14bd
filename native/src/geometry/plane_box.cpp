#include "geometry/plane_box.h"

#include <algorithm>

namespace spectral_conformal {

void PlaneBox::include(const PlaneBox& other) {
  for (int axis = 0; axis < 2; ++axis) {
    low[axis] = std::min(low[axis], other.low[axis]);
    high[axis] = std::max(high[axis], other.high[axis]);
  }
}

void PlaneBox::include(Complex point) { include(PlaneBox{{point.real(), point.imag()}, {point.real(), point.imag()}}); }

PlaneBox PlaneBox::of(std::initializer_list<Complex> points) {
  PlaneBox result;
  for (const Complex point : points) result.include(point);
  return result;
}

PlaneBox PlaneBox::of(const std::vector<Complex>& points) {
  PlaneBox result;
  for (const Complex point : points) result.include(point);
  return result;
}

}  // namespace spectral_conformal
