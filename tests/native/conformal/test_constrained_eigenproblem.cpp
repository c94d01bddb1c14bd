#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "conformal/constrained_eigenproblem.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// One u for the vertices.
LinearConstraints with_column(int n_vertices, const std::vector<int>& column) {
  LinearEquations equations;
  for (std::size_t k = 1; k < column.size(); ++k) equations.add({{2 * column[k - 1], 1}, {2 * column[k], -1}});
  return {equations, n_vertices};
}

/// Vertices on a line that leans.
LinearConstraints with_slanted_line(int n_vertices, const std::vector<int>& line) {
  LinearEquations equations;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const int a = 2 * line[k - 1];
    const int b = 2 * line[k];
    equations.add({{a, 0.6}, {b, -0.6}, {a + 1, 0.8}, {b + 1, -0.8}});
  }
  return {equations, n_vertices};
}

/// x^T A x = z^H H z for the coordinates x = (u_0, v_0, u_1, ...) of z.
Eigen::MatrixXd on_coordinates(const Eigen::MatrixXcd& hermitian) {
  Eigen::MatrixXd result(2 * hermitian.rows(), 2 * hermitian.cols());
  for (Eigen::Index i = 0; i < hermitian.rows(); ++i) {
    for (Eigen::Index j = 0; j < hermitian.cols(); ++j) {
      const Complex entry = hermitian(i, j);
      result.block<2, 2>(2 * i, 2 * j) << entry.real(), -entry.imag(), entry.imag(), entry.real();
    }
  }
  return result;
}

/// The smallest eigenvalue above that of the translations, from P^T B^ P x = mu P^T (L + s M) P x.
double dense_reference(const ConformalEnergy& energy, const BoundaryForm& form, const LinearConstraints& constraints) {
  const int n = energy.n_vertices();
  Eigen::MatrixXcd mass = Eigen::MatrixXcd::Zero(n, n);
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    mass(form.vertices[i], form.vertices[i]) = form.mass[static_cast<Eigen::Index>(i)];
  }
  const ComplexVector row = mass.diagonal();
  const Eigen::MatrixXcd centered = mass - row * row.transpose() / form.total();
  const double shift = 1e-3;
  const Eigen::MatrixXd p = constraints.expansion();
  const Eigen::MatrixXd shifted = p.transpose() * on_coordinates(dense(energy.matrix()) + shift * mass) * p;
  const Eigen::MatrixXd reduced = p.transpose() * on_coordinates(centered) * p;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(reduced, shifted);
  return 1 / solver.eigenvalues()[p.cols() - 1] - shift;
}

}  // namespace

TEST_SUITE("constrained_eigenproblem") {
  TEST_CASE("the eigenvalue is that of the dense problem, and the map meets the constraints") {
    for (const FactorizationBackend backend : backends()) {
      for (const int columns : {3, 12}) {
        const Patch patch(bumpy_grid(columns, 5));
        const ConformalEnergy energy = patch.energy(Weights::uniform);
        const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
        const std::vector<int> column{0, 1, 2, 3};
        const LinearConstraints constraints = with_column(energy.n_vertices(), column);
        REQUIRE(constraints.n_unknowns() == 2 * energy.n_vertices() - 3);
        const ConstrainedEigenpair found =
            solve_constrained_eigenproblem(energy, form, constraints, patch.positions, 1e-12, backend, {});
        REQUIRE(found.pair.converged);
        CHECK(1 / found.pair.mu == doctest::Approx(dense_reference(energy, form, constraints)).epsilon(1e-7));
        for (const int v : column) CHECK(found.pair.vector[v].real() == found.pair.vector[column[0]].real());
        const LinearConstraints slanted = with_slanted_line(energy.n_vertices(), column);
        const ConstrainedEigenpair leaning =
            solve_constrained_eigenproblem(energy, form, slanted, patch.positions, 1e-12, backend, {});
        REQUIRE(leaning.pair.converged);
        CHECK(1 / leaning.pair.mu == doctest::Approx(dense_reference(energy, form, slanted)).epsilon(1e-7));
      }
    }
  }

  TEST_CASE("without ties it is the map of Eq. 5, up to a similarity") {
    const Patch patch(bumpy_grid(9, 6));
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
    const ConstrainedEigenpair found = solve_constrained_eigenproblem(
        energy, form, {{}, energy.n_vertices()}, patch.positions, 1e-12, FactorizationBackend::automatic, {});
    REQUIRE(found.pair.converged);
    CHECK(difference_up_to_similarity(found.pair.vector, conformal_map(patch)) < 1e-8);
  }
}

}  // namespace spectral_conformal::test
