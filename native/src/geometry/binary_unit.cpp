#include "geometry/binary_unit.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {

void BinaryUnit::enlarge(double coordinate) {
  if (!std::isfinite(coordinate)) return;
  largest_ = std::abs(coordinate);
  // The unit and its inverse are normal numbers.
  constexpr int bound = -std::numeric_limits<double>::min_exponent;
  int exponent = 0;
  std::frexp(largest_, &exponent);
  exponent_ = std::clamp(exponent, -bound, bound);
  length_ = std::ldexp(1.0, exponent_);
  factor_ = 1 / length_;
}

int BinaryUnit::exponent() const { return exponent_; }

}  // namespace spectral_conformal
