#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "conformal/nearest_map.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE("nearest_map") {
  TEST_CASE("no other turn and no other map under the constraints is nearer in the Dirichlet energy") {
    const Patch patch(bumpy_grid(8, 6));
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
    const int n = energy.n_vertices();
    const ComplexVector z = flat_map(patch.positions);
    const auto nearest = [&](const LinearEquations& equations) {
      return nearest_map(energy, LinearConstraints::of(equations, n), form, patch.positions, 1e-12, z,
                         FactorizationBackend::automatic, {});
    };
    // Without constraints it is z.
    CHECK(difference_up_to_similarity(nearest({}), z) < 1e-9);
    LinearEquations equations;
    equations.add({{0, 1}, {14, -1}});
    equations.add({{14, 1}, {28, -1}});
    equations.add({{61, 1}, {63, -1}});
    const ComplexVector found = nearest(equations);
    CHECK(found[0].real() == found[7].real());
    CHECK(found[7].real() == found[14].real());
    CHECK(found[30].imag() == found[31].imag());
    const Eigen::MatrixXd dirichlet = dense(energy.matrix()).real();
    const auto distance = [&](const ComplexVector& x, double turn) {
      const ComplexVector difference = x - std::polar(1.0, turn) * z;
      return difference.dot(dirichlet * difference).real();
    };
    double least = infinity;
    for (int k = 0; k < 360; ++k) least = std::min(least, distance(found, 2 * pi * k / 360));
    const LinearConstraints constraints = LinearConstraints::of(equations, n);
    for (int k = 0; k < 12; ++k) {
      // The nearest for this turn, by normal equations.
      const ComplexVector turned = dirichlet * (std::polar(1.0, 2 * pi * k / 12) * z);
      Eigen::MatrixXd reduced(constraints.n_unknowns(), constraints.n_unknowns());
      for (int j = 0; j < constraints.n_unknowns(); ++j) {
        const ComplexVector image = dirichlet * constraints.expanded(Eigen::VectorXd::Unit(reduced.cols(), j));
        reduced.col(j) = constraints.gathered(image);
      }
      const Eigen::VectorXd w = (reduced + 1e-9 * Eigen::MatrixXd::Identity(reduced.rows(), reduced.cols()))
                                    .ldlt()
                                    .solve(constraints.gathered(turned));
      CHECK(distance(constraints.expanded(w), 2 * pi * k / 12) > least - 1e-3);
    }
  }
}

}  // namespace spectral_conformal::test
