#include <doctest/doctest.h>

#include "layout/placement.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

struct Placed {
  Patch patch;
  ConformalEnergy energy;
  explicit Placed(const Mesh& mesh) : patch(mesh), energy(patch.energy(Weights::uniform)) {}
  ComplexVector operator()(ComplexVector z, double area) const {
    REQUIRE(place(z, energy, patch.outer(), patch.positions, area));
    return z;
  }
};

/// A flat 3 x 8 grid of quads that stands on a short side.
Mesh standing_rectangle() {
  Mesh mesh = quad_grid(3, 8);
  for (auto& p : mesh.points) p = {p.x(), 0.0, p.y()};
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("placement");

TEST_CASE("signed area is the shoelace area, negative for a mirror image, whatever the weights") {
  const Patch patch(perforated_grid(7, 7));
  const ComplexVector z = random_map(patch.positions.rows());
  double expected = 0;
  for (const auto& loop : patch.chart.boundary_loops) expected += shoelace_area(loop, z);
  for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
    const ConformalEnergy energy = patch.energy(weights);
    CHECK(signed_area(energy, z) == doctest::Approx(expected).epsilon(1e-12));
    CHECK(signed_area(energy, z.conjugate()) == doctest::Approx(-expected).epsilon(1e-12));
  }
  const Patch quads(quad_grid(4, 3));
  CHECK(signed_area(quads.energy(Weights::uniform), flat_map(quads.positions)) == doctest::Approx(12));
}

TEST_CASE("the result is the map itself up to a similarity, centered, with the area asked for") {
  const Placed placed(perforated_grid(10, 7));
  const ComplexVector flat = flat_map(placed.patch.positions);
  const ComplexVector z = placed(Complex(0.2, 0.7) * flat, 5.0);
  CHECK(difference_up_to_similarity(z, flat) < 1e-13);
  CHECK(std::abs(z.mean()) < 1e-13);
  CHECK(signed_area(placed.energy, z) == doctest::Approx(5).epsilon(1e-13));
}

TEST_CASE("the result stands upright, however the map was turned") {
  const Placed placed(standing_rectangle());
  ComplexVector expected(placed.patch.positions.rows());
  for (Eigen::Index v = 0; v < expected.size(); ++v) {
    expected[v] = Complex(placed.patch.positions(v, 0) - 1.5, placed.patch.positions(v, 2) - 4);
  }
  for (const double angle : {0.0, 0.4, 1.6, 2.9, 4.4, 6.0}) {
    const ComplexVector turned = (std::polar(1e-3, angle) * expected).array() + Complex(7, -3);
    CHECK(difference(placed(turned, 24), expected) < 1e-9);
  }
}

TEST_CASE("a map without positive area is refused and left alone") {
  const Placed placed(bumpy_grid(4, 4));
  const ComplexVector flat = flat_map(placed.patch.positions);
  for (const ComplexVector& original : {ComplexVector(flat.conjugate()), ComplexVector(flat.real().cast<Complex>())}) {
    ComplexVector z = original;
    CHECK_FALSE(place(z, placed.energy, placed.patch.outer(), placed.patch.positions, 1.0));
    CHECK(z == original);
  }
  ComplexVector overflowing = 1e200 * flat;
  CHECK_FALSE(place(overflowing, placed.energy, placed.patch.outer(), placed.patch.positions, 1.0));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
