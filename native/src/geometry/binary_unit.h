#pragma once

#include <cmath>

namespace spectral_conformal {

/// A power of two next to the largest of some lengths: measured in it, squares neither overflow nor vanish, and to
/// change units rounds nothing.
class BinaryUnit {
 public:
  /// Makes the unit large enough for a coordinate; one that is not finite does not count.
  void include(double coordinate) {
    if (std::abs(coordinate) > largest_) enlarge(coordinate);
  }
  /// Makes the unit large enough for what another is large enough for.
  void include(const BinaryUnit& other) { include(other.largest_); }
  /// log2 of the unit; bounded, so that it has an inverse. 0 without a coordinate other than 0.
  int exponent() const;
  /// A length in this unit.
  double scaled(double length) const { return length * factor_; }
  /// An area in squares of this unit, in those of the coordinates.
  double area_of(double scaled_area) const { return scaled_area * length_ * length_; }

 private:
  void enlarge(double coordinate);

  double largest_ = 0;
  int exponent_ = 0;
  double length_ = 1;
  double factor_ = 1;
};

}  // namespace spectral_conformal
