#include "rebake/texel_coding.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace spectral_conformal {

TexelCoding TexelCoding::of(PixelType type, int n_channels, const RebakeOptions& options) {
  TexelCoding coding;
  coding.type_ = type;
  coding.n_channels_ = n_channels;
  const int n_first = n_channels < 3 ? 1 : 3;
  if (options.content == TextureContent::normals) coding.n_vectors_ = n_first;
  if (options.content == TextureContent::color && type != PixelType::float32) coding.n_colors_ = n_first;
  if (options.has_opacity && n_channels > n_first) coding.opacity_ = n_first;
  if (type == PixelType::uint8) coding.fill_tables<std::uint8_t>();
  if (type == PixelType::uint16) coding.fill_tables<std::uint16_t>();
  for (int c = 0; c < n_channels; ++c) {
    coding.table_of_[static_cast<std::size_t>(c)] = coding.tables_[c < n_first ? 0 : 1].data();
  }
  return coding;
}

template <class Integer>
void TexelCoding::fill_tables() {
  constexpr int highest = std::numeric_limits<Integer>::max();
  for (std::vector<float>& table : tables_) table.resize(highest + 1);
  for (int k = 0; k <= highest; ++k) {
    const double code = static_cast<double>(k) / highest;
    const double first = n_vectors_ > 0 ? 2 * code - 1 : n_colors_ > 0 ? linear_from_srgb(code) : code;
    tables_[0][static_cast<std::size_t>(k)] = static_cast<float>(first);
    tables_[1][static_cast<std::size_t>(k)] = static_cast<float>(code);
  }
}

TexelValue TexelCoding::decoded(const float* texel) const {
  TexelValue value{};
  for (int c = 0; c < n_channels_; ++c) {
    const auto k = static_cast<std::size_t>(c);
    value[k] = c < n_vectors_ ? 2 * texel[k] - 1 : texel[k];
  }
  return weighted(value);
}

template <class Integer>
Integer TexelCoding::code(std::size_t channel, float value) const {
  constexpr int highest = std::numeric_limits<Integer>::max();
  double code = value;
  if (static_cast<int>(channel) < n_colors_) {
    if constexpr (std::is_same_v<Integer, std::uint8_t>) return rounding_(value);
    code = srgb_from_linear(code);
  }
  // A NaN becomes 0.
  return code > 0 ? static_cast<Integer>(std::lround(highest * std::min(code, 1.0))) : Integer{0};
}

void TexelCoding::encode(TexelValue mean, void* pixels, std::size_t index) const {
  if (n_vectors_ == 3) {
    const double length = std::hypot(mean[0], mean[1], mean[2]);
    for (std::size_t c = 0; c < 3; ++c) {
      const double component = length > 0 ? mean[c] / length : c == 2 ? 1 : 0;
      mean[c] = static_cast<float>((component + 1) / 2);
    }
  }
  if (opacity_ >= 0) {
    const float factor = mean[static_cast<std::size_t>(opacity_)] + least_opacity;
    for (int c = 0; c < opacity_; ++c) mean[static_cast<std::size_t>(c)] /= factor;
  }
  const auto n = static_cast<std::size_t>(n_channels_);
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t at = index * n + c;
    if (type_ == PixelType::uint8) {
      static_cast<std::uint8_t*>(pixels)[at] = code<std::uint8_t>(c, mean[c]);
    } else if (type_ == PixelType::uint16) {
      static_cast<std::uint16_t*>(pixels)[at] = code<std::uint16_t>(c, mean[c]);
    } else {
      static_cast<float*>(pixels)[at] = mean[c];
    }
  }
}

}  // namespace spectral_conformal
