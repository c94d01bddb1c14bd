#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "packing/texel_snapping.h"

namespace spectral_conformal::test {
namespace {

/// One face with these corners, snapped.
std::vector<Complex> snapped(const std::vector<Complex>& corners, int island = 0) {
  ComplexVector points = Eigen::Map<const ComplexVector>(corners.data(), static_cast<Eigen::Index>(corners.size()));
  std::vector<int> numbers;
  for (std::size_t k = 0; k < corners.size(); ++k) numbers.push_back(static_cast<int>(k));
  snap_to_texels(points, {0, static_cast<int>(corners.size())}, numbers, {island}, 1);
  return {points.begin(), points.end()};
}

}  // namespace

TEST_SUITE_BEGIN("texel_snapping");

TEST_CASE("straight borders get to the nearest integers, and what lies between stretches") {
  const std::vector<Complex> hook{{0.3, 0.8}, {8.6, 0.8}, {8.6, 3.3}, {2.4, 3.3}, {2.4, 6.1}, {0.3, 6.1}};
  CHECK(snapped(hook) == std::vector<Complex>{{0, 1}, {9, 1}, {9, 3}, {2, 3}, {2, 6}, {0, 6}});
  // The tip of a triangle on a straight border moves in proportion; beyond a border all move as it does.
  const std::vector<Complex> house = snapped({{0.3, 0}, {4.3, 0}, {4.3, 4}, {2.3, 6.2}, {0.3, 4}});
  CHECK(std::abs(house[3] - Complex(2, 6.2)) < 1e-12);
}

TEST_CASE("no point moves more than half a texel, and none passes another") {
  std::vector<Complex> stairs{{0.2, 0.1}};
  for (int k = 0; k < 12; ++k) {
    const Complex last = stairs.back();
    stairs.push_back(last + 1.3);
    stairs.push_back(last + Complex(1.3, 1.1));
  }
  stairs.emplace_back(0.2, stairs.back().imag());
  const std::vector<Complex> moved = snapped(stairs);
  for (std::size_t k = 0; k < stairs.size(); ++k) {
    CHECK(std::abs(moved[k].real() - stairs[k].real()) <= max_snap + 1e-12);
    CHECK(std::abs(moved[k].imag() - stairs[k].imag()) <= max_snap + 1e-12);
    if (k > 1 && k % 2 == 0) CHECK(moved[k].imag() > moved[k - 2].imag());
  }
}

TEST_CASE("of borders within one texel the longest counts, and short ones do not") {
  // Two borders at u = 3.8 and 4.1 want to get to 4: the longer one does, the other keeps its distance.
  const std::vector<Complex> step = snapped({{0, 0}, {4.1, 0}, {4.1, 3}, {3.8, 3}, {3.8, 9}, {0, 9}});
  CHECK(step[3].real() == 4);
  CHECK(step[1].real() == doctest::Approx(4.3));
  const std::vector<Complex> small{{0.3, 0.3}, {0.9, 0.3}, {0.9, 0.9}, {0.3, 0.9}};
  CHECK(snapped(small) == small);
}

TEST_CASE("slanted and round borders, and faces of no island, stay") {
  std::vector<Complex> circle;
  for (int k = 0; k < 90; ++k) circle.push_back(std::polar(20.0, 0.02 + 2 * pi * k / 90) + Complex(0.37, 0.21));
  CHECK(snapped(circle) == circle);
  const std::vector<Complex> square{{0.3, 0.3}, {9.3, 0.3}, {9.3, 9.3}, {0.3, 9.3}};
  CHECK(snapped(square, -1) == square);
}

TEST_CASE("corners that rounding has moved off their border get to one coordinate") {
  const std::vector<Complex> moved = snapped({{0.3, 0}, {5, 1e-4}, {9.3, 0}, {9.3 + 1e-4, 5}, {0.3 - 1e-4, 5}});
  CHECK(moved[0].imag() == 0);
  CHECK(moved[1].imag() == 0);
  CHECK(moved[3].real() == 9);
  CHECK(moved[2].real() == 9);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
