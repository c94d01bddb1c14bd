#include <doctest/doctest.h>

#include <algorithm>

#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

const std::vector<std::array<int, 3>> quad_triangles(quad_splits.begin(), quad_splits.end());
const std::vector<TriangleWeight> quad_weights(4, split_of_quad);

std::vector<int> split_of(const std::array<Complex, 4>& corners) {
  return mapped_triangulation(quad_triangles, quad_weights, Eigen::Map<const ComplexVector>(corners.data(), 4));
}

/// The signed areas of the two triangles that a mapped quad is split into.
std::array<double, 2> areas_of_quad(const std::array<Complex, 4>& corners) {
  const std::vector<int> chosen = split_of(corners);
  REQUIRE(chosen.size() == 2);
  std::array<double, 2> areas;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [a, b, c] = quad_splits[static_cast<std::size_t>(chosen[i])];
    areas[i] = signed_area(corners[a], corners[b], corners[c]);
  }
  return areas;
}

}  // namespace

TEST_SUITE_BEGIN("quad_splits");

TEST_CASE("triangles are taken as they are, of quads one split, and every face is covered once") {
  const Patch triangles(flat_grid(4, 3));
  const std::size_t n = triangles.chart.triangles.size();
  const ComplexVector flat = flat_map(triangles.positions);
  CHECK(mapped_triangulation(triangles.chart.triangles, triangles.chart.triangle_weights, flat).size() == n);
  CHECK(mapped_triangulation(triangles.chart.triangles, {}, flat).size() == n);
  const Patch quads(quad_grid(4, 3));
  const std::vector<int> chosen =
      mapped_triangulation(quads.chart.triangles, quads.chart.triangle_weights, random_map(quads.positions.rows()));
  REQUIRE(chosen.size() == 24);
  CHECK(std::is_sorted(chosen.begin(), chosen.end()));
  for (std::size_t i = 0; i < 24; ++i) CHECK(quads.chart.triangle_face[chosen[i]] == static_cast<int>(i / 2));
}

TEST_CASE("triangulated surfaces list the four triangles of a quad in this order") {
  const Patch quad(quad_grid(1, 1));
  const std::array<int, 4> corner{0, 1, 3, 2};  // the face's corners, in order
  REQUIRE(quad.chart.triangles.size() == 4);
  for (std::size_t t = 0; t < 4; ++t) {
    CHECK(quad.chart.triangle_weights[t].in_both_splits());
    for (int k = 0; k < 3; ++k) CHECK(quad.chart.triangles[t][k] == corner[quad_splits[t][k]]);
  }
}

TEST_CASE("a quad that is concave in the map is split at its reflex corner, whichever that is, mirrored or not") {
  const std::array<Complex, 4> dart{Complex(0, 0), Complex(2, -1), Complex(0, 3), Complex(-2, -1)};
  for (int reflex = 0; reflex < 4; ++reflex) {
    std::array<Complex, 4> corners;
    std::array<Complex, 4> mirrored;
    for (int i = 0; i < 4; ++i) {
      corners[(i + reflex) % 4] = dart[i];
      mirrored[(i + reflex) % 4] = std::conj(dart[i]);
    }
    CHECK(areas_of_quad(corners) == std::array<double, 2>{3, 3});
    CHECK(areas_of_quad(mirrored) == std::array<double, 2>{-3, -3});
  }
}

TEST_CASE("a quad that crosses itself folds in either split") {
  const auto [first, second] = areas_of_quad({Complex(0, 0), Complex(2, 2), Complex(2, 0), Complex(0, 1)});
  CHECK(first * second < 0);
}

TEST_CASE("rounding does not choose the split, but the slightest fold does") {
  const std::vector<int> first{0, 1};
  const std::vector<int> second{2, 3};
  // A square whose corner 3 moves along the diagonal 1-3: the two triangles beside that diagonal stay equal.
  const auto kite = [](double tip) {
    return split_of({Complex(0, 1), Complex(0, 0), Complex(1, 0), Complex(tip, tip)});
  };
  for (const double noise : {-1e-12, 0.0, 1e-12}) CHECK(kite(1 + noise) == first);
  CHECK(kite(1 + 1e-6) == second);
  CHECK(kite(1 - 1e-6) == second);
  // Corner 1 a little inside the diagonal 0-2, so that the first split folds; then corner 0 inside 1-3.
  CHECK(split_of({Complex(0, 0), Complex(0.5, 0.5 + 1e-13), Complex(1, 1), Complex(0, 1)}) == second);
  CHECK(split_of({Complex(0.5 + 1e-13, 0.5), Complex(1, 0), Complex(1, 1), Complex(0, 1)}) == first);
}

TEST_CASE(
    "a map without flips keeps the first split of a quad, unless its diagonal is an edge and the second's is none") {
  const auto quads = [](const std::vector<std::array<int, 4>>& faces) {
    std::vector<std::array<int, 3>> triangles;
    for (const auto& face : faces) {
      for (const auto& [a, b, c] : quad_splits) triangles.push_back({face[a], face[b], face[c]});
    }
    return triangles;
  };
  const std::vector<TriangleWeight> two(8, split_of_quad);
  CHECK(drawable_triangulation(quad_triangles, quad_weights) == std::vector<int>{0, 1});
  CHECK(drawable_triangulation(quad_triangles, {}) == std::vector<int>{0, 1, 2, 3});
  CHECK(drawable_triangulation(quads({{0, 1, 2, 3}, {0, 3, 4, 5}}), two) == std::vector<int>{0, 1, 4, 5});
  // The second quad has the diagonal 0-2 of the first as an edge.
  CHECK(drawable_triangulation(quads({{0, 1, 2, 3}, {0, 4, 5, 2}}), two) == std::vector<int>{2, 3, 4, 5});
  // Its diagonal is that of the first: each edge is drawn once.
  CHECK(drawable_triangulation(quads({{0, 1, 2, 3}, {0, 4, 2, 5}}), two) == std::vector<int>{0, 1, 6, 7});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
