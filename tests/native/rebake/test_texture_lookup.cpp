#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "rebake/texture_lookup.h"

namespace spectral_conformal::test {
namespace {

constexpr TextureWrap every_wrap[]{TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp, TextureWrap::black};

/// 4 x 2 texels with the values 0 to 7, and lookups in it.
struct SmallTexture {
  explicit SmallTexture(TextureWrap wrap, bool is_nearest = false) {
    options.wrap = {wrap, wrap};
    options.is_nearest = is_nearest;
  }
  float at(double u, double v) const { return TextureLookup<float>(image, coding, options).at(u, v)[0]; }

  std::vector<float> texels{0, 1, 2, 3, 4, 5, 6, 7};
  ImageView image{texels.data(), PixelType::float32, 4, 2, 1};
  RebakeOptions options;
  TexelCoding coding = TexelCoding::of(PixelType::float32, 1, {});
};

}  // namespace

TEST_SUITE_BEGIN("texture_lookup");

TEST_CASE("the centers of texels have their values, from the upper left") {
  for (const TextureWrap wrap : every_wrap) {
    const SmallTexture texture(wrap);
    for (int k = 0; k < 8; ++k) CHECK(texture.at((k % 4 + 0.5) / 4, k < 4 ? 0.75 : 0.25) == static_cast<float>(k));
    CHECK(texture.at(0.25, 0.75) == 0.5F);
    CHECK(texture.at(0.25, 0.5) == 2.5F);
  }
}

TEST_CASE("beyond the border the texture repeats, is mirrored or stays") {
  const SmallTexture repeated(TextureWrap::repeat);
  const SmallTexture mirrored(TextureWrap::mirror);
  const SmallTexture clamped(TextureWrap::clamp);
  CHECK(repeated.at(0, 0.75) == 1.5F);
  CHECK(mirrored.at(0, 0.75) == 0);
  CHECK(clamped.at(0, 0.75) == 0);
  for (const int tiles : {-1000000, -3, -2, -1, 1, 2, 3, 1000000}) {
    const double u = 0.125 + tiles;
    CHECK(repeated.at(u, 0.75) == 0);
    CHECK(repeated.at(0.125, 0.75 + tiles) == 0);
    CHECK(mirrored.at(u, 0.75) == (tiles % 2 == 0 ? 0 : 3));
    CHECK(mirrored.at(0.125, 0.75 + tiles) == (tiles % 2 == 0 ? 0 : 4));
    CHECK(clamped.at(u, 0.75) == (tiles < 0 ? 0 : 3));
    CHECK(clamped.at(0.125, 0.75 + tiles) == (tiles < 0 ? 4 : 0));
  }
}

TEST_CASE("beyond the border nothing is left, if that is wanted") {
  const SmallTexture black(TextureWrap::black);
  CHECK(black.at(0.875, 0.25) == 7);
  CHECK(black.at(1, 0.25) == 3.5F);
  CHECK(black.at(1, 0) == 1.75F);
  for (const double beyond : {-1e6, -1.0, -0.125, 1.125, 2.0, 1e6}) {
    CHECK(black.at(beyond, 0.25) == 0);
    CHECK(black.at(0.875, 2 * beyond) == 0);
  }
}

TEST_CASE("the nearest texel, if that is wanted") {
  const SmallTexture texture(TextureWrap::repeat, true);
  CHECK(texture.at(0.26, 0.9) == 1);
  CHECK(texture.at(0.49, 0.1) == 5);
  CHECK(texture.at(-0.01, 0.1) == 7);
}

TEST_CASE("no coordinate reaches beyond the image") {
  const double huge = std::numeric_limits<double>::max();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const TextureWrap wrap : every_wrap) {
    const SmallTexture texture(wrap);
    for (const double u : {-huge, -1e-300, 0.0, std::nextafter(1.0, 0.0), 1.0, 1e17, huge, none}) {
      for (const double v : {-huge, 0.0, 1.0, huge, none}) {
        CHECK(texture.at(u, v) >= 0);
        CHECK(texture.at(u, v) <= 7);
      }
    }
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
