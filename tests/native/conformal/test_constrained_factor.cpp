#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#include "conformal/constrained_factor.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// Two vertices held, and a row of one v.
LinearEquations held_row(double extent) {
  LinearEquations equations;
  for (int v = 0; v < 5; ++v) equations.add({{2 * v + 1, 1}, {2 * v + 3, -1}});
  equations.held = {{0, 0.0}, {1, 0.0}, {60, extent}, {61, 1.0}};
  return equations;
}

}  // namespace

TEST_SUITE("constrained_factor") {
  TEST_CASE("it solves with P^T L P, on all unknowns and on some") {
    const Patch patch(bumpy_grid(8, 6));
    const int n = static_cast<int>(patch.positions.rows());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    LinearEquations many = held_row(3);
    for (int v = 10; v + 1 < n; ++v) many.add({{2 * v, 1}, {2 * v + 3, 2}});
    for (const auto backend : backends()) {
      for (const LinearEquations& equations : {held_row(3), many}) {
        const LinearConstraints constraints = LinearConstraints::of(equations, n);
        ConstrainedFactor factor = ConstrainedFactor::of_held(energy, constraints, patch.positions, backend, {});
        REQUIRE(factor.is_factored());
        // K w = P^T L P w, column by column.
        Eigen::MatrixXd k(constraints.n_unknowns(), constraints.n_unknowns());
        ComplexVector image;
        for (int j = 0; j < constraints.n_unknowns(); ++j) {
          energy.apply(constraints.expanded(Eigen::VectorXd::Unit(constraints.n_unknowns(), j)), image);
          k.col(j) = constraints.gathered(image);
        }
        const Eigen::LLT<Eigen::MatrixXd> dense(k);
        const ComplexVector b = flat_map(patch.positions);
        const Eigen::VectorXd expected = dense.solve(constraints.gathered(b));
        CHECK((factor.solve(b) - expected).norm() < 1e-9 * expected.norm());
        // Of a complex row perhaps one part.
        const std::vector<int> selected{3, 0, 7, 8, constraints.n_unknowns() - 1};
        factor.select(selected);
        const Eigen::VectorXd f = random_map(5).real();
        Eigen::VectorXd force = Eigen::VectorXd::Zero(constraints.n_unknowns());
        force(selected) = f;
        const Eigen::VectorXd answer = dense.solve(force);
        CHECK((factor.solve_from_selected(f) - answer).norm() < 1e-9 * answer.norm());
        Eigen::VectorXd y;
        factor.solve_selected(f, y);
        CHECK((y - answer(selected)).norm() < 1e-9 * answer.norm());
      }
    }
  }

  TEST_CASE("it serves other values for the same coordinates, and no other coordinates") {
    const Patch patch(bumpy_grid(8, 6));
    const int n = static_cast<int>(patch.positions.rows());
    const ConstrainedFactor factor =
        ConstrainedFactor::of_held(patch.energy(Weights::uniform), LinearConstraints::of(held_row(3), n),
                                   patch.positions, FactorizationBackend::automatic, {});
    CHECK(factor.serves(LinearConstraints::of(held_row(2), n)));
    LinearEquations other = held_row(3);
    other.held.back().first = 63;
    CHECK_FALSE(factor.serves(LinearConstraints::of(other, n)));
  }
}

}  // namespace spectral_conformal::test
