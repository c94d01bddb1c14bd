#include "geometry/plane_box.h"

#include <algorithm>

#include "geometry/tolerances.h"

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

bool MovingBox::meets(const MovingBox& other) const {
  double begin = 0;
  double end = 1;
  // Reduces the time to that in which one box does not lie beyond the other.
  const auto reduce = [&](const MovingBox& lower, const MovingBox& upper, int axis) {
    const double gap = upper.places.low[axis] - lower.places.high[axis];
    const double growth = upper.motions.low[axis] - lower.motions.high[axis];
    if (growth < 0) {
      begin = std::max(begin, -gap / growth);
    } else if (gap > 0) {
      end = -1;
    } else if (growth > 0) {
      end = std::min(end, -gap / growth);
    }
  };
  for (int axis = 0; axis < 2; ++axis) {
    reduce(*this, other, axis);
    reduce(other, *this, axis);
  }
  return begin <= end + sum_rounding;
}

void MovingBox::include(const MovingBox& other) {
  places.include(other.places);
  motions.include(other.motions);
}

}  // namespace spectral_conformal
