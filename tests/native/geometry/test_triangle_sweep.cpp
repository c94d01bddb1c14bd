#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "geometry/signed_area.h"
#include "geometry/triangle_sweep.h"

namespace spectral_conformal::test {
namespace {

using SweptCorners = std::array<Complex, 3>;

/// Of triangles with small integer corners, whose products are exact.
bool insides_meet(const SweptCorners& a, const SweptCorners& b) {
  for (const auto& [triangle, other] : {std::pair(a, b), std::pair(b, a)}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Complex side = triangle[(k + 1) % 3] - triangle[k];
      const auto is_beyond = [&, at = triangle[k]](Complex p) { return cross(side, p - at) <= 0; };
      if (std::all_of(other.begin(), other.end(), is_beyond)) return false;
    }
  }
  return true;
}

/// Sweeps; which of the triangles stay, of two that meet the one that `chooses` says.
std::vector<char> staying(const std::vector<SweptCorners>& triangles, const std::function<bool()>& chooses) {
  std::vector<char> stays(triangles.size(), 1);
  sweep_triangles(triangles, [&](int first, int second) {
    CHECK(stays[first] != 0);
    CHECK(stays[second] != 0);
    CHECK(insides_meet(triangles[first], triangles[second]));
    const int out = chooses() ? first : second;
    stays[out] = 0;
    return out;
  });
  return stays;
}

}  // namespace

TEST_SUITE_BEGIN("triangle_sweep");

TEST_CASE("of triangles on a lattice, those that stay do not meet; all are found that meet") {
  std::mt19937 generator(5);
  const auto below = [&](int n) { return static_cast<int>(generator() % static_cast<unsigned>(n)); };
  int n_pairs = 0;
  int n_touching = 0;
  for (int trial = 0; trial < 400; ++trial) {
    // Small ones on a wide lattice mostly touch; large ones mostly meet.
    const int size = 2 + below(4);
    const int lattice = 3 + below(12);
    std::vector<SweptCorners> triangles;
    while (triangles.size() < 40) {
      const Complex at(below(lattice), below(lattice));
      SweptCorners corners;
      for (Complex& corner : corners) corner = at + Complex(below(size), below(size));
      const double area = signed_area(corners[0], corners[1], corners[2]);
      if (area < 0) std::swap(corners[0], corners[1]);
      if (area != 0) triangles.push_back(corners);
    }
    const std::vector<char> stays = staying(triangles, [&] { return below(2) == 0; });
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t other = 0; other < t; ++other) {
        const bool meet = insides_meet(triangles[t], triangles[other]);
        n_pairs += meet ? 1 : 0;
        if (stays[t] == 0 || stays[other] == 0) continue;
        CHECK_FALSE(meet);
        for (const Complex p : triangles[t]) {
          n_touching += std::count(triangles[other].begin(), triangles[other].end(), p) > 0 ? 1 : 0;
        }
      }
    }
  }
  REQUIRE(n_pairs > 1000);
  REQUIRE(n_touching > 1000);
}

TEST_CASE("what shares corners and sides does not meet, whatever the place of the corners") {
  constexpr int n = 40;
  const auto never = []() -> bool {
    FAIL("two meet");
    return false;
  };
  for (const double turn : {0.0, 0.3, 1.0, 2.2}) {
    std::vector<SweptCorners> triangles;
    std::vector<Complex> border;
    for (int k = 0; k <= n; ++k) border.push_back(std::polar(1.0, turn + 2 * pi * (k % n) / n));
    for (int k = 0; k < n; ++k) triangles.push_back({Complex(0), border[k], border[k + 1]});
    // On the sides of others, from outside.
    for (int k = 0; k < n; ++k) triangles.push_back({border[k + 1], border[k], 2.0 * (border[k] + border[k + 1])});
    CHECK(staying(triangles, never) == std::vector<char>(triangles.size(), 1));
  }
  // Corners within sides, which run up, down and straight up.
  CHECK(staying({{Complex(0, 0), Complex(4, 0), Complex(0, 4)},
                 {Complex(2, 2), Complex(3, 2), Complex(2, 3)},
                 {Complex(0, 1), Complex(0, 3), Complex(-1, 2)},
                 {Complex(1, 0), Complex(0, -3), Complex(2, -1)},
                 {Complex(3, 0), Complex(2, -1), Complex(4, -1)}},
                never)
            .size() == 5);
}

TEST_CASE("a sweep ends where it is told to") {
  const SweptCorners triangle{Complex(0, 0), Complex(1, 0), Complex(0, 1)};
  int n_calls = 0;
  sweep_triangles(std::vector<SweptCorners>(5, triangle), [&](int, int) {
    ++n_calls;
    return -1;
  });
  CHECK(n_calls == 1);
  CHECK(staying(std::vector<SweptCorners>(5, triangle), [] { return true; }) == std::vector<char>{0, 0, 0, 0, 1});
  CHECK(staying({}, [] { return true; }).empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
