#include <doctest/doctest.h>

#include <algorithm>

#include "injective/local_unfolding.h"
#include "meshes.h"

namespace spectral_conformal::test {
TEST_SUITE_BEGIN("local_unfolding");

TEST_CASE("folds far apart and of different scale are unfolded, and what is far from them does not move") {
  const Patch patch(flat_grid(20, 20));
  const auto elements = patch.elements();
  // The exponential map: its scale varies by e^4.
  ComplexVector z = flat_map(patch.positions);
  for (Complex& value : z) value = std::exp(0.2 * Complex(value.real(), 0.3 * value.imag()));
  const ComplexVector clean = z;
  REQUIRE(count_flipped(elements, z, unplaced) == 0);
  const int small = 3 * 21 + 3;
  const int large = 16 * 21 + 16;
  for (const int v : {small, large}) z[v] += 1.7 * (z[v + 1] - z[v]);
  REQUIRE(count_flipped(elements, z, unplaced) >= 4);
  CHECK(unfold_locally(elements, {}, FactorizationBackend::automatic, z) == 0);
  CHECK(count_flipped(elements, z, unplaced) == 0);
  int unmoved = 0;
  for (Eigen::Index v = 0; v < z.size(); ++v) unmoved += z[v] == clean[v];
  // The corners of the flipped triangles may move, no others.
  CHECK(unmoved >= z.size() - 14);
}

TEST_CASE("held vertices stay, even where that leaves folds") {
  const Patch patch(flat_grid(6, 6));
  const auto elements = patch.elements();
  ComplexVector z = flat_map(patch.positions);
  z[24] += Complex(2.6, 0.3);
  const ComplexVector start = z;
  std::vector<char> held(static_cast<std::size_t>(z.size()), 0);
  held[24] = 1;
  SUBCASE("room for the others") {
    CHECK(unfold_locally(elements, held, FactorizationBackend::automatic, z) == 0);
    CHECK(z[24] == start[24]);
  }
  SUBCASE("none") {
    std::fill(held.begin(), held.end(), 1);
    CHECK(unfold_locally(elements, held, FactorizationBackend::automatic, z) ==
          count_flipped(elements, start, unplaced));
    CHECK(z == start);
  }
}

TEST_CASE("a collapsed triangle counts as flipped, a degenerate one in 3D does not") {
  Mesh mesh = flat_grid(4, 4);
  mesh.points.emplace_back(0.5 * (mesh.points[1] + mesh.points[2]));
  mesh.add({2, 1, static_cast<int>(mesh.points.size()) - 1});
  const Patch patch(mesh);
  const auto elements = patch.elements();
  ComplexVector z = flat_map(patch.positions);
  CHECK(count_flipped(elements, z, unplaced) == 0);
  z[12] = z[13];
  CHECK(count_flipped(elements, z, unplaced) == 2);
  CHECK(unfold_locally(elements, {}, FactorizationBackend::automatic, z) == 0);
}

TEST_CASE("maps of noise, in which most triangles bar the way of others, are unfolded") {
  const Patch patch(flat_grid(20, 20));
  const auto elements = patch.elements();
  for (unsigned seed = 1; seed <= 5; ++seed) {
    ComplexVector z = flat_map(patch.positions) + 1.2 * random_map(static_cast<int>(patch.positions.rows()), seed);
    REQUIRE(count_flipped(elements, z, unplaced) > 100);
    CHECK(unfold_locally(elements, {}, FactorizationBackend::automatic, z) == 0);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
