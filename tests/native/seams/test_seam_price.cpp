#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "seams/seam_price.h"

namespace spectral_conformal::test {
namespace {

/// An edge between two faces whose normals have this angle between them.
SeamGraph::Edge folded_by(double degrees) {
  const double angle = degrees * M_PI / 180;
  SeamGraph::Edge edge{{0, 1}, {0, 1}, 1, 1, false};
  edge.normal = Eigen::Vector3d(1 + std::cos(angle), std::sin(angle), 0);
  return edge;
}

}  // namespace

TEST_SUITE_BEGIN("seam_price");

TEST_CASE("the angle between the faces is that of their normals") {
  for (const double degrees : {0.0, 1.0, 35.0, 90.0, 179.0}) {
    CHECK(dihedral_angle(folded_by(degrees)) * 180 / M_PI == doctest::Approx(degrees).epsilon(1e-6));
  }
}

TEST_CASE("seams cost most across a flat region, their length at 20 degrees, and least along sharp edges") {
  CHECK(seam_price(folded_by(0)) == doctest::Approx(2));
  CHECK(seam_price(folded_by(20)) == doctest::Approx(1));
  CHECK(seam_price(folded_by(90)) == seam_price(folded_by(120)));
  double before = 2.1;
  for (double degrees = 0; degrees <= 90; degrees += 5) {
    const double price = seam_price(folded_by(degrees));
    CHECK(price <= before);
    CHECK(price > 0);
    before = price;
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
