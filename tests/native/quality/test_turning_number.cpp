#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "meshes.h"
#include "quality/turning_number.h"

namespace spectral_conformal::test {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

int turning(const BoundaryLoop& loop, const Triangles& triangles, const std::vector<Complex>& z) {
  const std::vector<TriangleWeight> triangle_weights(triangles.size());
  return turning_number(loop, triangles, triangle_weights, Eigen::Map<const ComplexVector>(z.data(), z.size()));
}

BoundaryLoop counted(int n) {
  BoundaryLoop loop(static_cast<std::size_t>(n));
  std::iota(loop.begin(), loop.end(), 0);
  return loop;
}

/// n points on a circle run through `times` times, and a last vertex in the center, joined to all.
int turning_of_circle(int n, int times) {
  Triangles triangles;
  std::vector<Complex> z;
  for (int i = 0; i < n; ++i) {
    triangles.push_back({i, (i + 1) % n, n});
    z.push_back(std::polar(1.0, 2 * pi * times * i / n));
  }
  z.push_back(0);
  return turning(counted(n), triangles, z);
}

}  // namespace

TEST_SUITE_BEGIN("turning_number");

TEST_CASE("circles run through once, backward, and two or three times without a flipped triangle") {
  CHECK(turning_of_circle(12, 1) == 1);
  CHECK(turning_of_circle(12, -1) == -1);
  CHECK(turning_of_circle(12, 2) == 2);
  CHECK(turning_of_circle(16, 3) == 3);
}

TEST_CASE("a figure eight does not turn") {
  const Triangles halves{{0, 1, 2}, {0, 2, 3}};
  CHECK(turning({0, 1, 2, 3}, halves, {0.0, {1, 1}, {1, 0}, {0, 1}}) == 0);
  CHECK(turning({0, 1, 2, 3}, halves, {0.0, {1, 0}, {1, 1}, {0, 1}}) == 1);
}

TEST_CASE("a boundary vertex whose triangles go around by more than 2 pi") {
  // Without the triangles the loop looks as if it wound twice.
  for (const double total : {1.9, 2.1, 2.5, 3.5, 4.2}) {
    constexpr int n = 12;
    std::vector<Complex> z{0.0};
    Triangles triangles;
    for (int i = 0; i <= n; ++i) z.push_back(std::polar(1.0 + 0.1 * i, total * pi * i / n));
    for (int i = 1; i <= n; ++i) triangles.push_back({0, i, i + 1});
    CHECK(turning(counted(n + 2), triangles, z) == 1);
  }
}

TEST_CASE("an ear that is folded over does not change the number of turns") {
  const Triangles triangles{{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};
  const BoundaryLoop loop{0, 4, 1, 2, 3};
  CHECK(turning(loop, triangles, {0.0, {1, 0}, {1, 1}, {0, 1}, {0.5, -0.5}}) == 1);
  CHECK(turning(loop, triangles, {0.0, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.3}}) == 1);
}

TEST_CASE("both splits of a quad count like one") {
  const std::vector<Complex> z{0.0, {1, 0}, {1, 1}, {0, 1}};
  const Triangles both{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  CHECK(turning_number({0, 1, 2, 3}, both, std::vector<TriangleWeight>(4, split_of_quad),
                       Eigen::Map<const ComplexVector>(z.data(), 4)) == 1);
}

TEST_CASE("edges without length are passed over, at the start too") {
  const Triangles triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  CHECK(turning(counted(5), triangles, {0.0, 0.0, {1, 0}, {1, 1}, {0, 1}}) == 1);
  CHECK(turning(counted(5), triangles, {0.0, {1, 0}, {1, 1}, {0, 1}, 0.0}) == 1);
  CHECK(turning(counted(5), triangles, {1.0, 1.0, 1.0, 1.0, 1.0}) == 0);
}

TEST_CASE("holes run the other way around") {
  const Patch patch(perforated_grid(6, 6));
  const ComplexVector z = flat_map(patch.positions);
  for (const BoundaryLoop& loop : patch.chart.boundary_loops) {
    const int expected = shoelace_area(loop, z) > 0 ? 1 : -1;
    CHECK(turning_number(loop, patch.chart.triangles, patch.chart.triangle_weights, z) == expected);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
