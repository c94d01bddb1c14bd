#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rebake/color_transfer.h"
#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal {

/// The channels of a texel in the form in which texels are averaged.
using TexelValue = std::array<float, max_channels>;

/// Converts stored texels to values and back. Values of color are linear light, those of a normal its components, and
/// where there is opacity, the other channels are multiplied by it.
class TexelCoding {
 public:
  static TexelCoding of(PixelType type, int n_channels, const RebakeOptions& options);
  TexelCoding(TexelCoding&&) = default;  ///< not copyable: it points into its tables
  TexelCoding& operator=(TexelCoding&&) = default;

  int n_channels() const { return n_channels_; }
  template <class Integer>
  TexelValue decoded(const Integer* texel) const {
    TexelValue value{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(n_channels_); ++c) value[c] = table_of_[c][texel[c]];
    return weighted(value);
  }
  TexelValue decoded(const float* texel) const;
  /// Linear light or data, multiplied by its opacity.
  TexelValue weighted(TexelValue value) const {
    if (opacity_ < 0) return value;
    float& opacity = value[static_cast<std::size_t>(opacity_)];
    if (!(opacity > 0)) opacity = 0;
    const float factor = opacity + least_opacity;
    for (int c = 0; c < opacity_; ++c) value[static_cast<std::size_t>(c)] *= factor;
    return value;
  }
  /// Writes a mean of values to the texel of this index.
  void encode(TexelValue mean, void* pixels, std::size_t index) const;

 private:
  /// What is transparent everywhere keeps its color. Below the smallest step of 16 bits.
  static constexpr float least_opacity = 0x1p-17F;

  TexelCoding() = default;
  template <class Integer>
  void fill_tables();
  template <class Integer>
  Integer code(std::size_t channel, float value) const;

  PixelType type_ = PixelType::uint8;
  int n_channels_ = 0;
  int n_colors_ = 0;   ///< first channels of integers that sRGB codes
  int n_vectors_ = 0;  ///< components of the normal
  int opacity_ = -1;   ///< the channel of the opacity; -1 for none
  SrgbRounding rounding_;
  std::array<std::vector<float>, 2> tables_;  ///< values of the codes of the first channels, and of the others
  std::array<const float*, max_channels> table_of_{};
};

}  // namespace spectral_conformal
