#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#include "conformal/reduced_factor.h"
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

TEST_SUITE("reduced_factor") {
  TEST_CASE("it solves with P^T L P, on all unknowns and on some") {
    const Patch patch(bumpy_grid(8, 6));
    const int n = static_cast<int>(patch.positions.rows());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    LinearEquations many = held_row(3);
    for (int v = 10; v + 1 < n; ++v) many.add({{2 * v, 1}, {2 * v + 3, 2}});
    LinearEquations pinned;
    pinned.held = held_row(3).held;
    for (const auto backend : backends()) {
      for (const LinearEquations& equations : {held_row(3), many, pinned}) {
        const LinearConstraints constraints = LinearConstraints::of(equations, n);
        ReducedFactor factor = ReducedFactor::of_held(energy, constraints, patch.positions, backend, {});
        REQUIRE(factor.is_factored());
        // K w = P^* L P w on the real view, column by column.
        const AffineSpace& space = factor.space();
        const auto unit = [&](int j) {
          ComplexVector w = ComplexVector::Zero(space.size());
          w[j / 2] = j % 2 == 0 ? Complex(1) : Complex(0, 1);
          return w;
        };
        std::vector<int> parts;
        for (int j = 0; j < 2 * space.size(); ++j) {
          if (j % 2 == 0 || !space.is_real()[j / 2]) parts.push_back(j);
        }
        const auto real = [&](const ComplexVector& w) {
          const Eigen::Map<const Eigen::VectorXd> all(reinterpret_cast<const double*>(w.data()), 2 * w.size());
          return Eigen::VectorXd(all(parts));
        };
        Eigen::MatrixXd k(parts.size(), parts.size());
        ComplexVector image;
        for (std::size_t j = 0; j < parts.size(); ++j) {
          energy.apply(space.expanded(unit(parts[j])), image);
          k.col(static_cast<Eigen::Index>(j)) = real(space.gathered(image));
        }
        const Eigen::LLT<Eigen::MatrixXd> dense(k);
        const ComplexVector f = space.gathered(flat_map(patch.positions));
        const Eigen::VectorXd expected = dense.solve(real(f));
        CHECK((real(factor.solve(f)) - expected).norm() < 1e-9 * expected.norm());
        CHECK(factor.inverse(flat_map(patch.positions)) == space.expanded(factor.solve(f)));
      }
    }
  }

  TEST_CASE("it serves other values for the same coordinates, and no other coordinates") {
    const Patch patch(bumpy_grid(8, 6));
    const int n = static_cast<int>(patch.positions.rows());
    const ReducedFactor factor =
        ReducedFactor::of_held(patch.energy(Weights::uniform), LinearConstraints::of(held_row(3), n), patch.positions,
                               FactorizationBackend::automatic, {});
    CHECK(factor.serves(LinearConstraints::of(held_row(2), n)));
    LinearEquations other = held_row(3);
    other.held.back().first = 63;
    CHECK_FALSE(factor.serves(LinearConstraints::of(other, n)));
  }

  TEST_CASE("what is singular is a failure, not a result") {
    Patch patch(flat_grid(2, 2));
    Positions with_stray_vertex(patch.positions.rows() + 1, 3);
    with_stray_vertex << patch.positions, Eigen::RowVector3d(5, 5, 5);
    const ConformalEnergy energy =
        conformal_energy(with_stray_vertex, patch.chart.triangles, patch.chart.triangle_weights, Weights::uniform);
    LinearEquations equations;
    equations.held = {{0, 0.0}, {1, 0.0}, {2, 1.0}, {3, 0.0}};
    const LinearConstraints constraints = LinearConstraints::of(equations, energy.n_vertices());
    for (const auto backend : backends()) {
      CHECK_FALSE(ReducedFactor::of_held(energy, constraints, with_stray_vertex, backend, {}).is_factored());
    }
  }
}

}  // namespace spectral_conformal::test
