#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "spectral_conformal/margin_fill.h"
#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal::test {
namespace {

/// A sheet of n x n quads with two maps; the old one is the unit square.
struct TwoMaps {
  std::vector<double> old_uv, new_uv;
  std::vector<int> triangles;

  template <class Move>
  TwoMaps(int n, const Move& move) {
    for (int k = 0; k < (n + 1) * (n + 1); ++k) {
      const double u = static_cast<double>(k % (n + 1)) / n;
      const double v = static_cast<double>(k / (n + 1)) / n;
      const auto [x, y] = move(u, v);
      old_uv.insert(old_uv.end(), {u, v});
      new_uv.insert(new_uv.end(), {x, y});
    }
    for (int k = 0; k < n * n; ++k) {
      const int a = k / n * (n + 1) + k % n;
      for (const int corner : {a, a + 1, a + n + 2, a + n + 2, a + n + 1, a}) triangles.push_back(corner);
    }
  }
  MapPair pair() const {
    MapPair maps;
    maps.old_uv = old_uv.data();
    maps.new_uv = new_uv.data();
    maps.triangles = triangles.data();
    maps.n_triangles = static_cast<int>(triangles.size() / 3);
    return maps;
  }
};

/// The coverage of an image without any.
std::vector<unsigned char> none_of(int side) {
  return std::vector<unsigned char>(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
}

std::vector<std::uint8_t> noise(int n) {
  std::mt19937 chance(1);
  std::vector<std::uint8_t> values(static_cast<std::size_t>(n));
  for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(chance() % 256);
  return values;
}

}  // namespace

TEST_SUITE_BEGIN("texture_rebake");

TEST_CASE("the same map gives the same image, a turned one the turned image") {
  constexpr int side = 96;
  std::vector<std::uint8_t> source = noise(side * side * 4);
  std::vector<std::uint8_t> target(source.size());
  RebakeOptions options;
  options.content = TextureContent::color;
  options.has_opacity = true;
  const ImageView from{source.data(), PixelType::uint8, side, side, 4};
  std::vector<unsigned char> coverage = none_of(side);
  const TargetImage to{{target.data(), PixelType::uint8, side, side, 4}, coverage.data()};
  const TwoMaps same(7, [](double u, double v) { return std::array<double, 2>{u, v}; });
  const std::vector<unsigned char> covered = rebake_texture(from, same.pair(), options, to, {});
  CHECK(std::count(covered.begin(), covered.end(), 1) == side * side);
  CHECK(target == source);
  CHECK(coverage == std::vector<unsigned char>(coverage.size(), full_coverage));
  const TwoMaps turned(7, [](double u, double v) { return std::array<double, 2>{1 - v, u}; });
  rebake_texture(from, turned.pair(), options, to, {});
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      for (std::size_t c = 0; c < 4; ++c) {
        // A quarter turn to the left, with rows from the top.
        REQUIRE(target[4 * ((side - 1 - x) * side + y) + c] == source[4 * (y * side + x) + c]);
      }
    }
  }
}

TEST_CASE("texels that are covered in part have the mean of that part") {
  constexpr int side = 50;
  const std::vector<std::uint8_t> source(side * side, 77);
  std::vector<std::uint8_t> target(side * side);
  for (const int factor : {1, 5}) {
    const int smaller = side / factor;
    const TwoMaps turned(3, [](double u, double v) {
      return std::array<double, 2>{0.3 + 0.5 * u - 0.2 * v, 0.1 + 0.2 * u + 0.5 * v};
    });
    std::vector<unsigned char> coverage = none_of(smaller);
    const TargetImage to{{target.data(), PixelType::uint8, smaller, smaller, 1}, coverage.data()};
    rebake_texture({source.data(), PixelType::uint8, side, side, 1}, turned.pair(), {}, to, {});
    fill_margin(to);
    CHECK(std::count(target.begin(), target.begin() + smaller * smaller, 77) == smaller * smaller);
  }
}

TEST_CASE("texels beside an island continue its border, others stay, and triangles without finite UVs are left out") {
  constexpr int side = 64;
  std::vector<std::uint8_t> source(3 * side * side);
  for (std::size_t k = 0; k < source.size(); ++k) source[k] = k / 3 % side < side / 2 ? 10 : 200;
  std::vector<std::uint8_t> target(source.size());
  TwoMaps half(4, [](double u, double v) { return std::array<double, 2>{0.25 + u / 2, 0.25 + v / 2}; });
  const ImageView from{source.data(), PixelType::uint8, side, side, 3};
  std::vector<unsigned char> coverage = none_of(side);
  const TargetImage to{{target.data(), PixelType::uint8, side, side, 3}, coverage.data()};
  RebakeOptions options;
  options.wrap = {TextureWrap::clamp, TextureWrap::clamp};
  std::fill(target.begin(), target.end(), 3);
  const std::vector<unsigned char> covered = rebake_texture(from, half.pair(), options, to, {});
  CHECK(std::count(covered.begin(), covered.end(), 1) == side * side / 4);
  // A row along each side and a texel at each corner.
  CHECK(std::count(coverage.begin(), coverage.end(), 0) == side * side - 34 * 34);
  for (std::size_t k = 0; k < covered.size(); ++k) {
    REQUIRE((coverage[k] == full_coverage) == (covered[k] == 1));
    for (std::size_t c = 0; c < 3; ++c) REQUIRE((target[3 * k + c] == 3) == (coverage[k] == 0));
  }
  fill_margin(to);
  for (std::size_t k = 0; k < source.size(); ++k) {
    const std::size_t x = k / 3 % side;
    if (x < 31 || x > 32) REQUIRE(target[k] == source[k]);
  }
  for (double& uv : half.old_uv) uv = std::nan("");
  std::fill(target.begin(), target.end(), 3);
  std::fill(coverage.begin(), coverage.end(), 0);
  const std::vector<unsigned char> none = rebake_texture(from, half.pair(), {}, to, {});
  CHECK(std::count(none.begin(), none.end(), 1) == 0);
  CHECK(coverage == none_of(side));
  CHECK(*std::max_element(target.begin(), target.end()) == 3);
}

TEST_CASE("between two pieces, texels continue the nearer border, whichever is drawn first") {
  constexpr int side = 32;
  const std::vector<std::uint8_t> left(1, 10);
  const std::vector<std::uint8_t> right(1, 200);
  // Texels 10 and 11 lie between them; the centers of both are nearer to one.
  const TwoMaps west(1, [](double u, double v) { return std::array<double, 2>{10.2 * u / side, v}; });
  const TwoMaps east(1, [](double u, double v) { return std::array<double, 2>{(11.9 + 10 * u) / side, v}; });
  for (const bool west_first : {true, false}) {
    std::vector<std::uint8_t> target(side * side);
    std::vector<unsigned char> coverage = none_of(side);
    const TargetImage to{{target.data(), PixelType::uint8, side, side, 1}, coverage.data()};
    for (const bool is_west : {west_first, !west_first}) {
      rebake_texture({is_west ? left.data() : right.data(), PixelType::uint8, 1, 1, 1}, (is_west ? west : east).pair(),
                     {}, to, {});
    }
    for (std::size_t k = 0; k < 22; ++k) CHECK(target[k] == (k <= 10 ? 10 : 200));
  }
}

TEST_CASE("values at corners are drawn linearly, and many small triangles by their mean") {
  constexpr int side = 16;
  std::vector<float> target(side * side);
  std::vector<unsigned char> coverage = none_of(side);
  const TargetImage to{{target.data(), PixelType::float32, side, side, 1}, coverage.data()};
  for (const int n : {3, 50}) {
    const TwoMaps sheet(n, [](double u, double v) { return std::array<double, 2>{u, v}; });
    std::vector<float> values;
    for (std::size_t k = 0; k < sheet.old_uv.size(); k += 2) values.push_back(static_cast<float>(sheet.old_uv[k]));
    const std::vector<unsigned char> covered = bake_corner_values(values.data(), sheet.pair(), {}, to, {});
    CHECK(std::count(covered.begin(), covered.end(), 1) == side * side);
    for (int k = 0; k < side * side; ++k) {
      CHECK(target[static_cast<std::size_t>(k)] == doctest::Approx((k % side + 0.5) / side).epsilon(0.01));
    }
  }
  // One value of light, as a color: its code.
  const TwoMaps sheet(3, [](double u, double v) { return std::array<double, 2>{u, v}; });
  std::vector<std::uint8_t> codes(side * side);
  RebakeOptions options;
  options.content = TextureContent::color;
  const std::vector<float> light(sheet.old_uv.size() / 2, 0.2158605F);
  const TargetImage coded{{codes.data(), PixelType::uint8, side, side, 1}, coverage.data()};
  bake_corner_values(light.data(), sheet.pair(), options, coded, {});
  CHECK(codes == std::vector<std::uint8_t>(side * side, 128));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
