#include <doctest/doctest.h>

#include <cmath>

#include "conformal/davidson.h"
#include "conformal/eigenproblem.h"
#include "conformal/extended_form.h"
#include "conformal/shifted_factor.h"
#include "geometry/tolerances.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("davidson");

namespace {

/// Leaves only part of a map where it resolves: 1e-7, as elsewhere.
constexpr double negligible = 1e-10;

DavidsonResult davidson(const ConformalEnergy& energy, const BoundaryForm& form, const Positions& positions,
                        const QuotientForm& quotient, double relative_shift, const Progress& progress = {}) {
  ReducedFactor factor =
      ReducedFactor::of_free(energy.matrix(), form, positions, relative_shift, FactorizationBackend::automatic, {});
  return solve_by_davidson(factor, energy, form, quotient, negligible, progress);
}

}  // namespace

TEST_CASE("a flat strip, most of whose eigenvalues lie below the shift, comes out as it is") {
  Mesh mesh = flat_grid(6001, 3);
  for (Eigen::Vector3d& point : mesh.points) point /= 6000;
  const Patch patch(mesh);
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const DavidsonResult result = davidson(energy, form, patch.positions, quotient_form(form), 1e-12);
  CHECK(result.change < negligible);
  CHECK(difference_up_to_similarity(result.z, flat_map(patch.positions)) < 1e-8);
}

TEST_CASE("it agrees with Lanczos where both resolve the map") {
  const Patch patch(bumpy_grid(12, 9));
  const ConformalEnergy energy = patch.energy(Weights::inverse_area);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::vertex);
  const ShiftedFactor factor =
      factor_shifted(energy.matrix(), patch.positions, form, 1e-12, FactorizationBackend::automatic, {});
  const Eigenpair expected = solve_eigenproblem(*factor.factorization, form, {}, {});
  const DavidsonResult result = davidson(energy, form, patch.positions, quotient_form(form), 1e-12);
  CHECK(difference_up_to_similarity(result.z, expected.vector) < 1e-7);
  // The shift affects the iteration, not its result.
  const DavidsonResult shifted = davidson(energy, form, patch.positions, quotient_form(form), 1e-4);
  CHECK(difference_up_to_similarity(shifted.z, result.z) < 1e-7);
}

TEST_CASE("an indefinite form has its smallest positive quotient, one positive for nothing has no map") {
  const Patch patch(bumpy_grid(9, 8));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  ExtendedForm pulled(form);
  pulled.add_extender({{patch.outer()[0]}, {patch.outer()[patch.outer().size() / 2]}, -0.3});
  const QuotientForm quotient{
      [&](const ComplexVector& z) { return pulled.value(pulled.restrict(z)); },
      [&](const ComplexVector& z, double factor, ComplexVector& sum) { pulled.add_applied(z, factor, sum); }};
  const DavidsonResult result = davidson(energy, form, patch.positions, quotient, 1e-8);
  // The next eigenvalue of such a form is near, so that rounding leaves more of it.
  CHECK(result.change < single_epsilon);
  ComplexVector r;
  const double lambda = eigen_residual(energy, quotient, result.z, r);
  CHECK(lambda > 0);
  CHECK(r.norm() < 1e-10 * result.z.norm());
  for (unsigned seed = 1; seed < 50; ++seed) {
    const ComplexVector other = result.z + 0.1 * result.z.norm() * random_map(result.z.size(), seed).normalized();
    if (quotient.value(other) > 0) CHECK(energy.value(other) / quotient.value(other) >= lambda);
  }

  const QuotientForm negative{
      [&](const ComplexVector& z) { return -form.value(z); },
      [&](const ComplexVector& z, double factor, ComplexVector& sum) { form.add_applied(z, -factor, sum); }};
  CHECK(std::isinf(davidson(energy, form, patch.positions, negative, 1e-8).change));
}

TEST_CASE("every solve asks whether to go on") {
  const Patch patch(bumpy_grid(9, 8));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  int calls = 0;
  const auto counting = [&](double, const char*) { return ++calls > 0; };
  const DavidsonResult result = davidson(energy, form, patch.positions, quotient_form(form), 1e-12, counting);
  CHECK(calls == result.solves);
  CHECK_THROWS_AS(davidson(energy, form, patch.positions, quotient_form(form), 1e-12,
                           [&](double, const char*) { return --calls > 2; }),
                  Cancelled);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
