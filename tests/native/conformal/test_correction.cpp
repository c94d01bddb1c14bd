#include <doctest/doctest.h>

#include <cmath>

#include "conformal/correction.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("correction");

TEST_CASE("the eigen-residual is L z - lambda B z with the quotient of Eq. 5") {
  const Patch patch(bumpy_grid(5, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const ComplexVector z = random_map(energy.n_vertices());
  ComplexVector r;
  const double lambda = eigen_residual(energy, quotient_form(form), z, r);
  CHECK(lambda == doctest::Approx(energy.value(z) / form.value(z)));
  ComplexVector expected = dense(energy.matrix()) * z;
  form.add_applied(z, -lambda, expected);
  CHECK(difference(r, expected) < 1e-13);
  CHECK(std::abs(z.dot(r)) < 1e-12 * energy.value(z));
}

TEST_CASE("corrections lead from a disturbed eigenvector back to it, whole or with the exact step") {
  const Patch patch(bumpy_grid(9, 8));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  for (const auto backend : backends()) {
    ReducedFactor factor = ReducedFactor::of_free(energy.matrix(), form, patch.positions, 1e-6, backend, {});
    CorrectionOptions options;
    options.max_corrections = 60;
    options.negligible = 1e-13;
    ComplexVector z = flat_map(patch.positions);
    const Correction first = correct(factor, energy, quotient_form(form), options, z);
    CHECK(first.change < 1e-9);
    CHECK((first.solves > 1 && first.solves <= 60));
    ComplexVector r;
    eigen_residual(energy, quotient_form(form), z, r);
    CHECK(r.norm() < 1e-12 * dense(energy.matrix()).diagonal().real().maxCoeff() * z.norm());
    for (const bool exact : {false, true}) {
      options.exact_step = exact;
      ComplexVector disturbed = z + 1e-3 * z.norm() / std::sqrt(static_cast<double>(z.size())) * random_map(z.size());
      correct(factor, energy, quotient_form(form), options, disturbed);
      CHECK(difference_up_to_similarity(disturbed, z) < 1e-7);
    }
  }
}

TEST_CASE("corrections are bounded, and none is an infinite change") {
  const Patch patch(bumpy_grid(4, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  ReducedFactor factor =
      ReducedFactor::of_free(energy.matrix(), form, patch.positions, 1e-8, FactorizationBackend::automatic, {});
  ComplexVector z = random_map(energy.n_vertices());
  CorrectionOptions options;
  CHECK(std::isinf(correct(factor, energy, quotient_form(form), options, z).change));
  options.max_corrections = 2;
  CHECK(correct(factor, energy, quotient_form(form), options, z).solves == 2);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
