#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "spectral_conformal/margin_fill.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("margin_fill");

TEST_CASE("every texel gets the value of a nearest covered one") {
  std::mt19937 chance(1);
  const std::vector<std::array<int, 3>> cases{{37, 23, 40}, {37, 23, 2}, {1, 50, 9},
                                              {50, 1, 9},   {16, 16, 1}, {99, 80, 999}};
  for (const auto& [width, height, share] : cases) {
    const auto n = static_cast<std::size_t>(width * height);
    std::vector<unsigned char> covered(n);
    // Two channels of 16 bits, which name the texel.
    std::vector<std::uint16_t> pixels(2 * n, 9);
    for (std::size_t k = 0; k < n; ++k) {
      covered[k] = chance() % static_cast<unsigned>(share) == 0 ? 1 : 0;
      if (covered[k] == 0) continue;
      pixels[2 * k] = static_cast<std::uint16_t>(k % static_cast<std::size_t>(width));
      pixels[2 * k + 1] = static_cast<std::uint16_t>(k / static_cast<std::size_t>(width));
    }
    fill_margin({{pixels.data(), PixelType::uint16, width, height, 2}, covered.data()});
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        int nearest = width * width + height * height;
        for (std::size_t k = 0; k < n; ++k) {
          if (covered[k] == 0) continue;
          const int dx = static_cast<int>(k) % width - x;
          const int dy = static_cast<int>(k) / width - y;
          nearest = std::min(nearest, dx * dx + dy * dy);
        }
        const std::size_t at = 2 * static_cast<std::size_t>(y * width + x);
        const int dx = pixels[at] - x;
        const int dy = pixels[at + 1] - y;
        REQUIRE(dx * dx + dy * dy == nearest);
      }
    }
  }
}

TEST_CASE("without a covered texel nothing changes") {
  std::vector<std::uint8_t> pixels(12, 7);
  std::vector<unsigned char> covered(4);
  fill_margin({{pixels.data(), PixelType::uint8, 2, 2, 3}, covered.data()});
  CHECK(pixels == std::vector<std::uint8_t>(12, 7));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
