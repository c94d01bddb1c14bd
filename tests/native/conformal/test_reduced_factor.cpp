#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

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

/// Of free maps, with the form of the border.
struct Free {
  Patch patch{bumpy_grid(6, 5)};
  ConformalEnergy energy = patch.energy(Weights::uniform);
  BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  ReducedFactor factor(HermitianMatrix&& matrix, double relative_shift, FactorizationBackend backend) const {
    return ReducedFactor::of(std::move(matrix), std::nullopt, form, patch.positions, relative_shift, backend, {});
  }
};

}  // namespace

TEST_SUITE("reduced_factor") {
  TEST_CASE("of free maps it is the factor of L + s M") {
    const Free f;
    for (const auto backend : backends()) {
      ReducedFactor factor = f.factor(f.energy.matrix(), 1e-6, backend);
      REQUIRE(factor.is_factored());
      CHECK(factor.shift() > 0);
      Eigen::MatrixXcd shifted = dense(f.energy.matrix());
      for (std::size_t i = 0; i < f.form.vertices.size(); ++i) {
        shifted(f.form.vertices[i], f.form.vertices[i]) += factor.shift() * f.form.mass[static_cast<Eigen::Index>(i)];
      }
      const ComplexVector x = random_map(f.energy.n_vertices());
      ComplexVector solved;
      factor.factorization().solve(shifted * x, solved);
      CHECK(difference(solved, x) < 1e-7);
    }
  }

  TEST_CASE("a matrix that no shift makes definite has no factor, and the last shift is reported") {
    const Free f;
    for (const auto backend : backends()) {
      const double first = f.factor(f.energy.matrix(), 1e-8, backend).shift();
      HermitianMatrix indefinite = f.energy.matrix();
      int inner = 0;
      while (std::find(f.form.vertices.begin(), f.form.vertices.end(), inner) != f.form.vertices.end()) ++inner;
      indefinite.valuePtr()[indefinite.outerIndexPtr()[inner]] = -1;
      const ReducedFactor factor = f.factor(std::move(indefinite), 1e-8, backend);
      CHECK_FALSE(factor.is_factored());
      CHECK(factor.shift() == doctest::Approx(1e6 * first));  // 1e-2 of L
    }
  }

  TEST_CASE("a form without mass has no factor") {
    Free f;
    f.form = {};
    for (const auto backend : backends()) CHECK_FALSE(f.factor(f.energy.matrix(), 1e-12, backend).is_factored());
  }

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
