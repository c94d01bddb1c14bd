#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "injective/grid_embedding.h"
#include "mesh/boundary_loops.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

ComplexVector draw(const Patch& patch) {
  const auto& loops = patch.chart.boundary_loops;
  return grid_embedding(patch.chart.triangles, loops, outer_loop(loops, patch.positions), patch.chart.n_vertices());
}

void check_drawing(const Patch& patch) {
  const ComplexVector z = draw(patch);
  REQUIRE(z.size() == patch.positions.rows());
  CHECK(count_flipped(patch, z) == 0);
  std::set<std::pair<double, double>> places;
  const auto size = static_cast<double>(z.size() + static_cast<Eigen::Index>(patch.chart.boundary_loops.size()));
  for (const Complex p : z) {
    CHECK((p.real() == std::floor(p.real()) && p.imag() == std::floor(p.imag())));
    CHECK((p.real() >= 0 && p.real() <= 2 * size && p.imag() >= 0 && p.imag() <= size));
    places.insert({p.real(), p.imag()});
  }
  CHECK(places.size() == static_cast<std::size_t>(z.size()));
}

}  // namespace

TEST_SUITE_BEGIN("grid_embedding");

TEST_CASE("every vertex has a place of its own on the grid, and no triangle is flipped") {
  Mesh triangle;
  triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.add({0, 1, 2});
  // The last has edges within that join vertices of its border.
  for (const Mesh& mesh : {triangle, flat_grid(1, 1), bumpy_grid(9, 7), flat_grid(1, 30)}) check_drawing(Patch(mesh));
}

TEST_CASE("holes are closed by a vertex each") {
  for (const Mesh& mesh : {perforated_grid(6, 6), perforated_grid(12, 9)}) check_drawing(Patch(mesh));
}

TEST_CASE("a limb of any length has its place") {
  // A tube of three sides, closed at its far end: a circle's embedding shrinks it by ten thousands of orders.
  Mesh mesh;
  constexpr int n_rings = 20000;
  for (int ring = 0; ring < n_rings; ++ring) {
    for (const Complex p : {Complex(1, 0), std::polar(1.0, 2 * pi / 3), std::polar(1.0, 4 * pi / 3)}) {
      mesh.points.emplace_back(p.real(), p.imag(), ring);
    }
  }
  mesh.points.emplace_back(0, 0, n_rings);
  for (int v = 0; v < 3 * n_rings; ++v) {
    const int next = v % 3 < 2 ? v + 1 : v - 2;
    if (v >= 3 * (n_rings - 1)) {
      mesh.add({v, next, 3 * n_rings});
    } else {
      mesh.add({v, next, next + 3});
      mesh.add({v, next + 3, v + 3});
    }
  }
  const Patch patch(mesh);
  CHECK(count_flipped(patch, draw(patch)) == 0);
}

TEST_CASE("two edges between the same vertices have no drawing with straight edges") {
  // A loop about vertex 1 that touches vertex 0 from both sides.
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {0, 2, 1}, {0, 1, 3}};
  CHECK(grid_embedding(triangles, {{0, 1, 3}}, 0, 4).size() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
