#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "rebake/texel_coding.h"

namespace spectral_conformal::test {
namespace {

TexelValue half_of_each(const TexelValue& first, const TexelValue& second) {
  TexelValue mean;
  for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = (first[c] + second[c]) / 2;
  return mean;
}

template <class Integer>
void check_all_codes(PixelType type) {
  for (const TextureContent content : {TextureContent::data, TextureContent::color}) {
    for (const int n_channels : {1, 2, 3, 4}) {
      RebakeOptions options;
      options.content = content;
      options.has_opacity = n_channels % 2 == 0;
      const TexelCoding coding = TexelCoding::of(type, n_channels, options);
      constexpr unsigned highest = std::numeric_limits<Integer>::max();
      for (unsigned k = 0; k <= highest; ++k) {
        // Any opacity, also none.
        const std::vector<Integer> texel{static_cast<Integer>(k), static_cast<Integer>(3 * k), static_cast<Integer>(~k),
                                         static_cast<Integer>(7 * k)};
        std::vector<Integer> written(static_cast<std::size_t>(n_channels) + 1, 9);
        coding.encode(coding.decoded(texel.data()), written.data(), 0);
        for (std::size_t c = 0; c < static_cast<std::size_t>(n_channels); ++c) REQUIRE(written[c] == texel[c]);
        REQUIRE(written.back() == 9);
      }
    }
  }
}

}  // namespace

TEST_SUITE_BEGIN("texel_coding");

TEST_CASE("every code stays through decoding and encoding") {
  check_all_codes<std::uint8_t>(PixelType::uint8);
  check_all_codes<std::uint16_t>(PixelType::uint16);
}

TEST_CASE("colors are averaged as light, data as numbers") {
  RebakeOptions options;
  const std::vector<std::uint8_t> black{0, 0, 0, 0};
  const std::vector<std::uint8_t> white{255, 255, 255, 255};
  for (const bool is_color : {false, true}) {
    options.content = is_color ? TextureContent::color : TextureContent::data;
    const TexelCoding coding = TexelCoding::of(PixelType::uint8, 4, options);
    std::vector<std::uint8_t> mean(4);
    coding.encode(half_of_each(coding.decoded(black.data()), coding.decoded(white.data())), mean.data(), 0);
    CHECK(mean == std::vector<std::uint8_t>(is_color ? std::vector<std::uint8_t>{188, 188, 188, 128}
                                                     : std::vector<std::uint8_t>{128, 128, 128, 128}));
  }
}

TEST_CASE("what is transparent does not color what is not") {
  RebakeOptions options;
  options.has_opacity = true;
  const TexelCoding coding = TexelCoding::of(PixelType::float32, 4, options);
  const std::vector<float> red{1, 0, 0, 1};
  const std::vector<float> clear_green{0, 1, 0, 0};
  std::vector<float> mean(4);
  coding.encode(half_of_each(coding.decoded(red.data()), coding.decoded(clear_green.data())), mean.data(), 0);
  CHECK(mean[0] == doctest::Approx(1).epsilon(1e-4));
  CHECK(mean[1] == doctest::Approx(0).epsilon(1e-4));
  CHECK(mean[3] == 0.5F);
  coding.encode(coding.decoded(clear_green.data()), mean.data(), 0);
  CHECK(mean[1] == doctest::Approx(1));
}

TEST_CASE("a mean of normals becomes a unit vector") {
  RebakeOptions options;
  options.content = TextureContent::normals;
  const TexelCoding coding = TexelCoding::of(PixelType::float32, 3, options);
  const std::vector<float> along_x{1, 0.5F, 0.5F};
  const std::vector<float> along_z{0.5F, 0.5F, 1};
  std::vector<float> mean(6);
  coding.encode(half_of_each(coding.decoded(along_x.data()), coding.decoded(along_z.data())), mean.data(), 1);
  CHECK(mean[0] == 0);
  CHECK(mean[3] == doctest::Approx(0.5 + std::sqrt(0.125)));
  CHECK(mean[4] == doctest::Approx(0.5));
  CHECK(mean[5] == doctest::Approx(0.5 + std::sqrt(0.125)));
  // Opposite normals cancel: the surface's own.
  coding.encode(TexelValue{}, mean.data(), 0);
  CHECK(mean[2] == 1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
