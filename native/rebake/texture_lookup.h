#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "rebake/texel_coding.h"
#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal {

/// Values of an image between its texels. Pixel: as in the image's PixelType.
template <class Pixel>
class TextureLookup {
 public:
  /// The image and `coding` must outlive the object.
  TextureLookup(const ImageView& image, const TexelCoding& coding, const RebakeOptions& options)
      : image_(image), coding_(coding), options_(options) {}

  /// Bilinear; from the values of four texels, not from their codes.
  TexelValue at(double u, double v) const {
    // Rows run down.
    const Place x = place(u, image_.width, options_.wrap[0]);
    const Place y = place(1 - v, image_.height, options_.wrap[1]);
    if (options_.is_nearest) return texel(x.nearest(), y.nearest());
    const TexelValue upper = between(texel(x.first, y.first), texel(x.second, y.first), x.share);
    const TexelValue lower = between(texel(x.first, y.second), texel(x.second, y.second), x.share);
    return between(upper, lower, y.share);
  }

 private:
  /// Two neighboring texels along an axis.
  struct Place {
    int first = 0;
    int second = 0;
    float share = 0;  ///< of the second
    int nearest() const { return share < 0.5F ? first : second; }
  };

  /// Of a coordinate in units of the image.
  static Place place(double t, int n, TextureWrap wrap) {
    if (wrap == TextureWrap::repeat) t -= std::floor(t);
    if (wrap == TextureWrap::mirror) t -= 2 * std::floor(t / 2);
    // A NaN becomes -1.
    const double bounded = std::min(std::max(-1.0, t * n - 0.5), 2.0 * n);
    const double low = std::floor(bounded);
    const int first = static_cast<int>(low);
    return {wrapped(first, n, wrap), wrapped(first + 1, n, wrap), static_cast<float>(bounded - low)};
  }

  /// The texel that stands at index k, from -1 to 2 n + 1; -1 for none.
  static int wrapped(int k, int n, TextureWrap wrap) {
    if (k >= 0 && k < n) return k;
    if (wrap == TextureWrap::repeat) return (k + n) % n;
    if (wrap == TextureWrap::clamp) return k < 0 ? 0 : n - 1;
    if (wrap == TextureWrap::black) return -1;
    // Mirrored copies alternate with plain ones.
    const int in_period = (k + 2 * n) % (2 * n);
    return in_period < n ? in_period : 2 * n - 1 - in_period;
  }

  TexelValue texel(int x, int y) const {
    if (x < 0 || y < 0) return coding_.decoded(black_.data());
    const std::size_t index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x);
    return coding_.decoded(static_cast<const Pixel*>(image_.pixels) +
                           index * static_cast<std::size_t>(image_.n_channels));
  }

  static TexelValue between(const TexelValue& first, const TexelValue& second, float share) {
    TexelValue value;
    for (std::size_t c = 0; c < value.size(); ++c) value[c] = (1 - share) * first[c] + share * second[c];
    return value;
  }

  const ImageView& image_;
  const TexelCoding& coding_;
  const RebakeOptions& options_;
  std::array<Pixel, max_channels> black_{};
};

}  // namespace spectral_conformal
