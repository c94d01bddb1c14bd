#include "geometry/binary_unit.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {

void BinaryUnit::enlarge(double coordinate) {
  if (!std::isfinite(coordinate)) return;
  largest_ = std::abs(coordinate);
  int exponent = 0;
  std::frexp(largest_, &exponent);
  // The unit and its inverse are normal numbers.
  using Limits = std::numeric_limits<double>;
  exponent_ = std::clamp(exponent, Limits::min_exponent, -Limits::min_exponent);
  length_ = std::ldexp(1.0, exponent_);
  factor_ = 1 / length_;
}

int BinaryUnit::exponent() const { return exponent_; }

}  // namespace spectral_conformal
