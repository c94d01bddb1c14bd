#include "geometry/binary_unit.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {

void BinaryUnit::enlarge(double coordinate) {
  if (!std::isfinite(coordinate)) return;
  largest_ = std::abs(coordinate);
  constexpr int bound = 1000;  // 2^1000 and its inverse are normal numbers
  int exponent = 0;
  std::frexp(largest_, &exponent);
  exponent_ = std::clamp(exponent, -bound, bound);
  length_ = std::ldexp(1.0, exponent_);
  factor_ = 1 / length_;
}

int BinaryUnit::exponent() const { return exponent_; }

}  // namespace spectral_conformal
