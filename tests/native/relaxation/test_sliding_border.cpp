#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "geometry/signed_area.h"
#include "meshes.h"
#include "relaxation/sliding_border.h"

namespace spectral_conformal::test {
namespace {

BoundaryLoop loop_of(const ComplexVector& z) {
  BoundaryLoop loop(static_cast<std::size_t>(z.size()));
  std::iota(loop.begin(), loop.end(), 0);
  return loop;
}

/// A side of 5 edges from 0 to 5 (1 + i), a quarter of a circle of radius 2 in 6 edges, and the way back over a corner.
ComplexVector side_and_bend() {
  ComplexVector z(13);
  for (int k = 0; k <= 5; ++k) z[k] = static_cast<double>(k) * Complex(1, 1);
  const Complex middle = z[5] + 2.0 * std::polar(1.0, 0.75 * pi);
  for (int k = 1; k <= 6; ++k) z[5 + k] = middle + 2.0 * std::polar(1.0, pi * (k / 12.0 - 0.25));
  z[12] = Complex(0, 9);
  return z;
}

}  // namespace

TEST_SUITE_BEGIN("sliding_border");

TEST_CASE("straight parts, bends and corners are told apart") {
  const ComplexVector z = side_and_bend();
  const std::vector<BorderTurn> turns = border_turns({loop_of(z)}, z);
  for (int v = 0; v < 13; ++v) {
    CAPTURE(v);
    const bool is_corner = v == 0 || v == 11 || v == 12;
    CHECK(turns[v] == (is_corner ? BorderTurn::corner : v < 5 ? BorderTurn::straight : BorderTurn::curved));
  }
}

TEST_CASE("a vertex slides exactly along a straight part, and near the circle along a bend") {
  const ComplexVector z = side_and_bend();
  std::vector<char> slides(13, 1);
  slides[0] = slides[11] = slides[12] = 0;
  const SlidingBorder border = SlidingBorder::along({loop_of(z)}, z, slides);
  const ComplexVector start = border.coordinates(z);
  CHECK(border.map_at(start) == z);
  const Complex middle = z[5] + 2.0 * std::polar(1.0, 0.75 * pi);
  for (const double s : {-0.9, -0.3, 0.2, 0.5}) {
    CAPTURE(s);
    ComplexVector x = start;
    for (int v = 0; v < 13; ++v) x[v] += slides[v] != 0 ? s : 0;
    const ComplexVector moved = border.map_at(x);
    for (int v = 1; v < 4; ++v) CHECK(moved[v].real() == doctest::Approx(moved[v].imag()).epsilon(1e-14));
    for (int v = 7; v < 11; ++v) CHECK(std::abs(moved[v] - middle) == doctest::Approx(2).epsilon(2e-3));
    CHECK(moved[12] == z[12]);
  }
}

TEST_CASE("the derivative is that of the map, and pulling back is its adjoint") {
  const ComplexVector z = side_and_bend();
  std::vector<char> slides(13, 1);
  slides[0] = slides[11] = slides[12] = 0;
  const SlidingBorder border = SlidingBorder::along({loop_of(z)}, z, slides);
  ComplexVector x = border.coordinates(z);
  for (int v = 0; v < 13; ++v) x[v] += slides[v] != 0 ? 0.3 * std::sin(v) : 0;
  ComplexVector displacement = random_map(13);
  for (int v = 0; v < 13; ++v) {
    if (slides[v] != 0) displacement[v] = displacement[v].real();
  }
  ComplexVector pushed = displacement;
  border.push_forward(x, pushed);
  const double h = 1e-6;
  const ComplexVector difference =
      (border.map_at(x + h * displacement) - border.map_at(x - h * displacement)) / (2 * h);
  CHECK((pushed - difference).norm() < 1e-8);
  const ComplexVector gradient = random_map(13);
  ComplexVector pulled = gradient;
  border.pull_back(x, pulled);
  double in_map = 0;
  double in_x = 0;
  for (int v = 0; v < 13; ++v) {
    in_map += dot(gradient[v], pushed[v]);
    in_x += dot(pulled[v], displacement[v]);
  }
  CHECK(in_x == doctest::Approx(in_map).epsilon(1e-12));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
