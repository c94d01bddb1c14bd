#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/ear_clipping.h"
#include "geometry/signed_area.h"

namespace spectral_conformal::test {
namespace {

double area_of(const std::vector<Complex>& points, const std::vector<std::array<int, 3>>& triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) area += signed_area(points[a], points[b], points[c]);
  return area;
}

const std::vector<Complex> outer_square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};

}  // namespace

TEST_SUITE_BEGIN("ear_clipping");

TEST_CASE("outlines with bridges, slits, spikes and corners twice are covered once") {
  std::vector<Complex> keyhole = outer_square;
  keyhole.insert(keyhole.end(), {{0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}});
  std::vector<Complex> slit = outer_square;
  slit.insert(slit.begin() + 1, {{2, 0}, {2, 2}, {2, 0}});
  std::vector<Complex> spike = outer_square;
  spike.insert(spike.begin() + 2, {{6, 0}, {4, 0}});
  std::vector<Complex> twice;
  for (const Complex p : keyhole) twice.insert(twice.end(), {p, p});
  for (const auto& [outline, area] : {std::pair(keyhole, 15.0), {slit, 16.0}, {spike, 16.0}, {twice, 15.0}}) {
    const auto triangles = clip_ears(outline, 0);
    CHECK(triangles.size() == outline.size() - 2);
    CHECK(area_of(outline, triangles) == doctest::Approx(area));
    CHECK(covers_once(outline, triangles, 1e-9));
  }
}

TEST_CASE("corners on edges and bridges in one line, up to single precision, are covered once") {
  const auto inserted = [](std::size_t at, const std::vector<Complex>& part) {
    std::vector<Complex> outline = outer_square;
    outline.insert(outline.begin() + static_cast<std::ptrdiff_t>(at), part.begin(), part.end());
    return outline;
  };
  const std::vector<std::vector<Complex>> outlines{
      {{0, 0}, {1, 2}, {3, 3}, {0, 3}, {1, 3}},  // a spike along an edge
      // Two bridges from one corner, a hole at the first ends on the second, before or behind it.
      inserted(4, {{0, 0}, {1, 1}, {1, 2}, {1.2, 1.2}, {1, 1}, {0, 0}, {2, 2}, {2, 3}, {3, 3}, {3, 2}, {2, 2}}),
      inserted(4, {{0, 0}, {2, 2}, {2, 3}, {3, 3}, {3, 2}, {2, 2}, {0, 0}, {1, 1}, {1.5, 1.3}, {1.5, 1}, {1, 1}}),
      // The same from within an edge.
      inserted(1, {{2, 0},
                   {2, 1},
                   {1.5, 1},
                   {1.5, 1.5},
                   {2, 1},
                   {2, 0},
                   {2, 2},
                   {1.5, 2.5},
                   {2, 3},
                   {2.5, 2.5},
                   {2, 2},
                   {2, 0}}),
  };
  std::mt19937 generator(1);
  const auto chance = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  for (const std::vector<Complex>& outline : outlines) {
    double area = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) area += 0.5 * cross(outline[i], outline[(i + 1) % outline.size()]);
    for (int k = 0; k < 50; ++k) {
      const Complex turn = std::polar(1.0, 2 * pi * chance());
      std::vector<Complex> placed;
      for (const Complex p : outline) {
        const Complex q = turn * p;
        placed.emplace_back(static_cast<float>(q.real()), static_cast<float>(q.imag()));
      }
      std::rotate(placed.begin(), placed.begin() + k % static_cast<int>(placed.size()), placed.end());
      const auto triangles = clip_ears(placed, 1e-6);
      REQUIRE(triangles.size() == outline.size() - 2);
      CHECK(area_of(placed, triangles) == doctest::Approx(area));
      CHECK(covers_once(placed, triangles, 1e-6));
    }
  }
  // A corner beyond an edge by more than the tolerance.
  const std::vector<Complex> dented = inserted(3, {{2, -1e-4}});
  CHECK_FALSE(covers_once(dented, clip_ears(dented, 1e-6), 1e-6));
}

TEST_CASE("what covers a place twice or backward is found, up to the tolerance") {
  const std::vector<Complex> star{{1, 0}, {-0.8, 0.6}, {0.3, -0.95}, {0.3, 0.95}, {-0.8, -0.6}};
  CHECK_FALSE(covers_once(star, clip_ears(star, 0), 1e-9));
  const std::vector<Complex> points{{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.9, 0}, {0, 2}};
  CHECK(covers_once(points, {{0, 1, 2}, {1, 3, 2}}, 1e-9));
  CHECK_FALSE(covers_once(points, {{0, 2, 1}}, 1e-9));
  CHECK_FALSE(covers_once(points, {{0, 1, 2}, {4, 3, 2}}, 1e-9));
  CHECK(covers_once(points, {{0, 1, 2}, {4, 3, 2}}, 0.1));
}

TEST_CASE("a large polygon is clipped") {
  std::vector<Complex> star;
  for (int k = 0; k < 20000; ++k) star.push_back(std::polar(k % 2 == 0 ? 1.0 : 0.5, 2 * pi * k / 20000));
  CHECK(area_of(star, clip_ears(star, 0)) == doctest::Approx(0.5 * 20000 * 0.5 * std::sin(2 * pi / 20000)));
}

TEST_CASE("triangles about one point cover once up to rounding; one that lies over another is found") {
  constexpr int n = 300;
  std::mt19937 generator(4);
  const auto noise = [&] { return 1e-8 * (static_cast<double>(generator()) / 4294967296.0 - 0.5); };
  std::vector<Complex> points;
  std::vector<std::array<int, 3>> triangles;
  for (int k = 0; k < n; ++k) {
    for (const Complex p : {Complex(0), std::polar(1.0, 2 * pi * k / n), std::polar(1.0, 2 * pi * (k + 1) / n)}) {
      points.push_back(p + Complex(noise(), noise()));
    }
    triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  CHECK(covers_once(points, triangles, 1e-6));
  CHECK_FALSE(covers_once(points, triangles, 0));
  const int over = n / 2;
  points[3 * over] *= 2.0;
  points[3 * over + 1] = points[3 * over - 2];
  CHECK_FALSE(covers_once(points, triangles, 1e-6));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
