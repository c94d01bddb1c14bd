#include <doctest/doctest.h>

#include <algorithm>

#include "conformal/shifted_factor.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("shifted_factor");

TEST_CASE("the factor is that of L + s M") {
  const Patch patch(bumpy_grid(6, 5));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  for (const auto backend : backends()) {
    const ShiftedFactor factor = factor_shifted(energy.matrix(), patch.positions, form, 1e-6, backend, {});
    REQUIRE(factor.factorization);
    CHECK(factor.shift > 0);
    Eigen::MatrixXcd shifted = dense(energy.matrix());
    for (std::size_t i = 0; i < form.vertices.size(); ++i) {
      shifted(form.vertices[i], form.vertices[i]) += factor.shift * form.mass[static_cast<Eigen::Index>(i)];
    }
    const ComplexVector x = random_map(energy.n_vertices());
    ComplexVector solved;
    factor.factorization->solve(shifted * x, solved);
    CHECK(difference(solved, x) < 1e-7);
  }
}

TEST_CASE("a matrix that no shift makes definite has no factor, and the last shift is reported") {
  const Patch patch(bumpy_grid(4, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  for (const auto backend : backends()) {
    const double first = factor_shifted(energy.matrix(), patch.positions, form, 1e-8, backend, {}).shift;
    HermitianMatrix indefinite = energy.matrix();
    int inner = 0;
    while (std::find(form.vertices.begin(), form.vertices.end(), inner) != form.vertices.end()) ++inner;
    indefinite.valuePtr()[indefinite.outerIndexPtr()[inner]] = -1;
    const ShiftedFactor factor = factor_shifted(std::move(indefinite), patch.positions, form, 1e-8, backend, {});
    CHECK_FALSE(factor.factorization);
    CHECK(factor.shift == doctest::Approx(1e6 * first));  // 1e-2 of L
  }
}

TEST_CASE("a form without mass has no factor") {
  const Patch patch(bumpy_grid(4, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  for (const auto backend : backends()) {
    CHECK_FALSE(factor_shifted(energy.matrix(), patch.positions, {}, 1e-12, backend, {}).factorization);
  }
}

TEST_CASE("the listener can stop it") {
  const Patch patch(bumpy_grid(4, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  for (const int stop_at : {1, 2}) {
    int calls = 0;
    const Progress stop = [&](double, const char*) { return ++calls < stop_at; };
    CHECK_THROWS_AS(
        factor_shifted(energy.matrix(), patch.positions, form, 1e-12, FactorizationBackend::automatic, stop),
        Cancelled);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
