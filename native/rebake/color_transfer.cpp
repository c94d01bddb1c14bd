#include "rebake/color_transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spectral_conformal {

double linear_from_srgb(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

double srgb_from_linear(double light) {
  if (!(light > 0)) return 0;
  if (light >= 1) return 1;
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

SrgbRounding::SrgbRounding() {
  least_[0] = -std::numeric_limits<float>::infinity();
  least_[256] = std::numeric_limits<float>::infinity();
  for (int code = 1; code < 256; ++code) {
    least_[static_cast<std::size_t>(code)] = static_cast<float>(linear_from_srgb((code - 0.5) / 255));
  }
  int code = 0;
  for (int k = 0; k < n_guesses; ++k) {
    const float light = static_cast<float>(k) / n_guesses;
    while (light >= least_[static_cast<std::size_t>(code) + 1]) ++code;
    guess_[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(code);
  }
}

std::uint8_t SrgbRounding::operator()(float light) const {
  // A NaN becomes 0.
  const float inside = light > 0 ? std::min(light, 1.0F) : 0.0F;
  const int k = std::min(static_cast<int>(inside * n_guesses), n_guesses - 1);
  std::size_t code = guess_[static_cast<std::size_t>(k)];
  while (inside >= least_[code + 1]) ++code;
  return static_cast<std::uint8_t>(code);
}

}  // namespace spectral_conformal
