#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "rebake/triangle_samples.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("triangle_samples");

TEST_CASE("the triangles of a grid share the samples of an image among them") {
  constexpr int n = 9;
  constexpr int side = 40;
  std::mt19937 chance(1);
  std::uniform_real_distribution<double> offset(-0.4, 0.4);
  // A part of the corners lies on centers of texels, where edges need a rule.
  std::vector<Complex> points;
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    const Complex at(-2 + 5 * (k % (n + 1)) + 0.5, -2 + 5 * (k / (n + 1)) + 0.5);
    points.push_back(k % 3 == 0 ? at : at + 2.5 * Complex(offset(chance), offset(chance)));
  }
  for (const int rate : {1, 2, 5}) {
    std::vector<int> counts(side * side, 0);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const std::size_t a = static_cast<std::size_t>(i * (n + 1) + j);
        const std::size_t c = a + n + 1;
        const std::array<std::array<Complex, 3>, 2> halves{
            {{points[a], points[a + 1], points[c + 1]}, {points[c + 1], points[c], points[a]}}};
        for (const std::array<Complex, 3>& half : halves) {
          TriangleSamples samples = TriangleSamples::of(half);
          samples.set_rates(rate, rate);
          CHECK(samples.weight() == doctest::Approx(1.0 / (rate * rate)));
          const TexelWindow box = samples.window(side, side);
          samples.for_each({0, side, 0, side}, [&](int x, int y, PlaceInTriangle place) {
            ++counts[static_cast<std::size_t>(y * side + x)];
            CHECK(x >= box.x_begin);
            CHECK(x < box.x_end);
            CHECK(y >= box.y_begin);
            CHECK(y < box.y_end);
            const Complex at = place.between(half[0], half[1], half[2]);
            CHECK(std::abs(at.real() - x - 0.5) < 0.5);
            CHECK(std::abs(at.imag() - y - 0.5) < 0.5);
          });
        }
      }
    }
    for (const int count : counts) CHECK(count == rate * rate);
  }
}

TEST_CASE("a window gets its part of the samples") {
  TriangleSamples samples = TriangleSamples::of({Complex(1, 2), Complex(90, 11), Complex(30, 77)});
  samples.set_rates(2, 3);
  int all = 0;
  samples.for_each({0, 100, 0, 100}, [&](int, int, PlaceInTriangle) { ++all; });
  int in_parts = 0;
  for (int x = 0; x < 100; x += 20) {
    for (int y = 0; y < 100; y += 50) {
      samples.for_each({x, x + 20, y, y + 50}, [&](int at_x, int at_y, PlaceInTriangle) {
        CHECK(at_x / 20 == x / 20);
        CHECK(at_y / 50 == y / 50);
        ++in_parts;
      });
    }
  }
  CHECK(in_parts == all);
  // Half of the parallelogram, six samples to a texel.
  CHECK(all == doctest::Approx(6 * 0.5 * (89 * 75 - 9 * 29)).epsilon(0.02));
}

TEST_CASE("the change of the place per texel follows the triangle") {
  const TriangleSamples samples = TriangleSamples::of({Complex(0, 0), Complex(4, 0), Complex(0, -8)});
  CHECK(samples.change(0).second == 0.25);
  CHECK(samples.change(0).third == 0);
  CHECK(samples.change(1).second == 0);
  CHECK(samples.change(1).third == -0.125);
}

TEST_CASE("rates follow the length of a texel in the source") {
  CHECK(TriangleSamples::rate_for(0) == 1);
  CHECK(TriangleSamples::rate_for(1.05) == 1);
  CHECK(TriangleSamples::rate_for(1.1) == 2);
  CHECK(TriangleSamples::rate_for(infinity) == TriangleSamples::max_rate);
  CHECK(TriangleSamples::rate_for(unmeasured) == 1);
}

TEST_CASE("triangles without area, without finite corners or beyond the image have no samples") {
  const double huge = 1e300;
  const std::vector<std::array<Complex, 3>> triangles{
      {Complex(0, 0), Complex(5, 5), Complex(9, 9)},          {Complex(0, 0), Complex(0, 0), Complex(9, 9)},
      {Complex(0, 0), Complex(unmeasured, 0), Complex(0, 9)}, {Complex(0, 0), Complex(infinity, 0), Complex(0, 9)},
      {Complex(0, 0), Complex(huge, 0), Complex(0, huge)},    {Complex(-9, 0), Complex(-1, 0), Complex(-1, 9)}};
  for (const std::array<Complex, 3>& corners : triangles) {
    const TriangleSamples samples = TriangleSamples::of(corners);
    const TexelWindow window = samples.window(10, 10);
    CHECK((window.x_begin >= window.x_end || window.y_begin >= window.y_end || corners[1].real() == huge));
    samples.for_each({0, 10, 0, 10}, [&](int, int, PlaceInTriangle) { CHECK(corners[1].real() == huge); });
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
