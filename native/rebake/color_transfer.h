#pragma once

#include <array>
#include <cstdint>

namespace spectral_conformal {

/// The transfer function of sRGB (IEC 61966-2-1), from a code in [0, 1] to linear light.
double linear_from_srgb(double code);
/// Its inverse; values outside [0, 1] are clamped.
double srgb_from_linear(double light);

/// Rounds linear light to the nearest 8-bit code of sRGB.
class SrgbRounding {
 public:
  SrgbRounding();
  std::uint8_t operator()(float light) const;

 private:
  static constexpr int n_guesses = 4096;
  std::array<float, 257> least_;  ///< light of each code; the last is infinite
  /// For light from k / n_guesses on, a code that is not too high.
  std::array<std::uint8_t, n_guesses> guess_;
};

}  // namespace spectral_conformal
