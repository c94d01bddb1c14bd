#include <doctest/doctest.h>

#include "conformal/eigenproblem.h"
#include "conformal/extended_eigenproblem.h"
#include "conformal/refined_eigenvector.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("refined_eigenvector");

namespace {

struct SolvedEigenproblem {
  Patch patch{bumpy_grid(9, 7)};
  ConformalEnergy energy = patch.energy(Weights::uniform);
  BoundaryForm boundary = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  Attempt attempt{1e-12, 0, 6, 1.0, false};
  ReducedFactor factor =
      ReducedFactor::of_free(energy.matrix(), boundary, patch.positions, 1e-12, FactorizationBackend::automatic, {});
  EarlierMaps earlier;
  Eigenvector of(const EigenproblemForm& form) {
    const EigenproblemOptions options = eigenproblem_options(attempt, 1e-8);
    Eigenpair pair;
    if (form.extended) {
      const auto starts = starts_of(*form.extended, boundary, 0, earlier.z);
      pair = solve_extended_eigenproblem(factor, energy, *form.extended, options, starts, earlier.free, {});
    } else if (form.is_area) {
      pair = solve_area_eigenproblem(factor, energy, boundary, options, {});
    } else {
      pair = solve_eigenproblem(factor.factorization(), boundary, options, {});
    }
    return refined_eigenvector(pair, energy, form, factor, attempt, 1e-8, {});
  }
};

}  // namespace

TEST_CASE("lambda is the quotient of Eq. 5, and no other vector has a smaller one") {
  SolvedEigenproblem solved;
  const Eigenvector v = solved.of({solved.boundary});
  REQUIRE(v.converged);
  CHECK((v.residual < 1e-10 && v.change < v.change_limit && v.solves > 0));
  CHECK(v.lambda == doctest::Approx(solved.energy.value(v.z) / solved.boundary.value(v.z)));
  for (unsigned seed = 0; seed < 3; ++seed) {
    const ComplexVector other = v.z + 0.01 * random_map(v.z.size(), seed);
    CHECK(v.lambda < solved.energy.value(other) / solved.boundary.value(other));
  }
}

TEST_CASE("soft constraints that do nothing leave the eigenvector, and the next solve begins with it") {
  SolvedEigenproblem solved;
  const Eigenvector plain = solved.of({solved.boundary});
  ExtendedForm none(solved.boundary);
  none.add_extender({{3}, {40}, 0.0});
  const Eigenvector first = solved.of({solved.boundary, &none});
  REQUIRE(first.converged);
  CHECK(first.lambda == doctest::Approx(plain.lambda));
  CHECK(difference_up_to_similarity(first.z, plain.z) < 1e-6);
  CHECK(solved.earlier.free.complex.vectors.cols() > 0);
  CHECK(solved.of({solved.boundary, &none}).solves < first.solves);
}

TEST_CASE("with B = A lambda is the quotient of the area form") {
  SolvedEigenproblem solved;
  const Eigenvector v = solved.of({solved.boundary, nullptr, true});
  REQUIRE(v.converged);
  CHECK(v.lambda == doctest::Approx(solved.energy.value(v.z) / solved.energy.area_form(v.z)));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
