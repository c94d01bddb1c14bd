#include <doctest/doctest.h>

#include "conformal/start_vector.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("start_vector");

TEST_CASE("runs once around the boundary by mass") {
  const Patch patch(bumpy_grid(9, 7));
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const ComplexVector y = start_vector(form, 0);
  REQUIRE(y.size() == form.mass.size());
  double turned = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    CHECK(std::abs(y[i]) == doctest::Approx(std::sqrt(form.mass[i])).epsilon(0.1));
    turned += std::arg(y[(i + 1) % y.size()] / y[i]);
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
