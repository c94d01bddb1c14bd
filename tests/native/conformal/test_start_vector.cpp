#include <doctest/doctest.h>

#include "conformal/start_vector.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("start_vector");

TEST_CASE("runs once around the boundary by mass") {
  const Patch patch(bumpy_grid(9, 7));
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const ComplexVector z = start_vector(form, 0);
  REQUIRE(z.size() == form.mass.size());
  double turned = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    CHECK(std::abs(z[i]) == doctest::Approx(1).epsilon(0.1));
    turned += std::arg(z[(i + 1) % z.size()] / z[i]);
  }
  CHECK(turned == doctest::Approx(2 * 3.14159265358979));
}

TEST_CASE("is the same every time, and another one for another start") {
  const BoundaryForm form = identity_form(20);
  CHECK(start_vector(form, 0) == start_vector(form, 0));
  CHECK(start_vector(form, 1) == start_vector(form, 1));
  CHECK(start_vector(form, 1) != start_vector(form, 2));
  CHECK(start_vector(form, 1) != start_vector(form, 0));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
