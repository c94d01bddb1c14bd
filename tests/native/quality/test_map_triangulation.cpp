#include <doctest/doctest.h>

#include "meshes.h"
#include "quality/map_triangulation.h"

namespace spectral_conformal::test {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Twice the signed areas of the two triangles of a quad whose corners have these places.
std::array<double, 2> areas_of_quad(const std::array<Complex, 4>& corners) {
  const Patch patch(quad_grid(1, 1));
  // The corners of its face, in order, are the vertices 0, 1, 3 and 2.
  const ComplexVector z = (ComplexVector(4) << corners[0], corners[1], corners[3], corners[2]).finished();
  const MapTriangulation map = triangulate_map(patch.chart, z);
  REQUIRE(map.triangles.size() == 2);
  std::array<double, 2> areas;
  for (int t = 0; t < 2; ++t) {
    const auto& [a, b, c] = map.triangles[t];
    areas[t] = std::imag(std::conj(z[b] - z[a]) * (z[c] - z[a]));
  }
  return areas;
}

}  // namespace

TEST_SUITE_BEGIN("map_triangulation");

TEST_CASE("triangles are taken as they are, of quads one split, and every face is covered once") {
  const Patch triangles(flat_grid(4, 3));
  CHECK(triangulate_map(triangles.chart, flat_map(triangles.positions)).triangles == triangles.chart.triangles);
  const Patch quads(quad_grid(4, 3));
  const MapTriangulation map = triangulate_map(quads.chart, flat_map(quads.positions));
  REQUIRE(map.triangles.size() == 24);
  REQUIRE(map.face.size() == 24);
  for (std::size_t t = 0; t < 24; ++t) CHECK(map.face[t] == static_cast<int>(t / 2));
}

TEST_CASE("a quad that is concave in the map is split at its inward corner, whichever that is, mirrored or not") {
  const std::array<Complex, 4> dart{Complex(0, 0), Complex(2, -1), Complex(0, 3), Complex(-2, -1)};
  for (int inward = 0; inward < 4; ++inward) {
    std::array<Complex, 4> corners;
    std::array<Complex, 4> mirrored;
    for (int i = 0; i < 4; ++i) {
      corners[(i + inward) % 4] = dart[i];
      mirrored[(i + inward) % 4] = std::conj(dart[i]);
    }
    CHECK(areas_of_quad(corners) == std::array<double, 2>{6, 6});
    CHECK(areas_of_quad(mirrored) == std::array<double, 2>{-6, -6});
  }
}

TEST_CASE("a quad that crosses itself folds in either split") {
  const auto [first, second] = areas_of_quad({Complex(0, 0), Complex(2, 2), Complex(2, 0), Complex(0, 1)});
  CHECK(first * second < 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
