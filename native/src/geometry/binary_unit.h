#pragma once

#include <cmath>

namespace spectral_conformal {

/// A power of two near the largest of some lengths. In this unit squares neither overflow nor underflow, and changing
/// units is exact.
class BinaryUnit {
 public:
  /// Makes the unit large enough for a coordinate; ignores non-finite ones.
  void include(double coordinate) {
    if (std::abs(coordinate) > largest_) enlarge(coordinate);
  }
  /// Makes the unit at least as large as another.
  void include(const BinaryUnit& other) { include(other.largest_); }
  /// log2 of the unit; bounded, so that the unit has an inverse. 0 without nonzero coordinates.
  int exponent() const;
  /// Converts a length to this unit.
  double scaled(double length) const { return length * factor_; }
  /// Converts a length, or a vector, from this unit to that of the coordinates.
  template <class Length>
  Length length_of(const Length& scaled_length) const {
    return scaled_length * length_;
  }
  /// Converts an area from squares of this unit to squares of the coordinates' unit.
  double area_of(double scaled_area) const { return scaled_area * length_ * length_; }

 private:
  void enlarge(double coordinate);

  double largest_ = 0;
  int exponent_ = 0;
  double length_ = 1;
  double factor_ = 1;
};

}  // namespace spectral_conformal
