#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "conformal/constrained_eigenproblem.h"
#include "conformal/extended_eigenproblem.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// One u for the vertices.
LinearConstraints with_column(int n_vertices, const std::vector<int>& column) {
  LinearEquations equations;
  for (std::size_t k = 1; k < column.size(); ++k) equations.add({{2 * column[k - 1], 1}, {2 * column[k], -1}});
  return LinearConstraints::of(equations, n_vertices);
}

/// Vertices on a line that leans.
LinearConstraints with_slanted_line(int n_vertices, const std::vector<int>& line) {
  LinearEquations equations;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const int a = 2 * line[k - 1];
    const int b = 2 * line[k];
    equations.add({{a, 0.6}, {b, -0.6}, {a + 1, 0.8}, {b + 1, -0.8}});
  }
  return LinearConstraints::of(equations, n_vertices);
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

/// The smallest positive eigenvalue above that of the translations, from P^T B P x = mu (P^T L P + t t^T) x with the
/// translations t, on which B vanishes.
double dense_reference(const ConformalEnergy& energy, const ExtendedForm& form, const LinearConstraints& constraints) {
  const int n = energy.n_vertices();
  // Column by column: the attraction of pins without turns has no complex matrix.
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (int j = 0; j < 2 * n; ++j) {
    ComplexVector unit = ComplexVector::Zero(n);
    unit[j / 2] = j % 2 == 0 ? Complex(1, 0) : Complex(0, 1);
    ComplexVector image = ComplexVector::Zero(n);
    form.add_applied(unit, 1, image);
    b.col(j) = Eigen::Map<const Eigen::VectorXd>(reinterpret_cast<const double*>(image.data()), 2 * n);
  }
  CHECK((b - b.transpose()).norm() < 1e-12 * b.norm());
  const Eigen::MatrixXd p = constraints.expansion();
  Eigen::MatrixXd matrix = p.transpose() * on_coordinates(dense(energy.matrix())) * p;
  for (const int axis : {0, 1}) {
    const Eigen::VectorXd along = constraints.translation(axis);
    if (along.size() > 0) matrix += along * along.transpose();
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(p.transpose() * b * p, matrix);
  return 1 / solver.eigenvalues()[p.cols() - 1];
}

Eigenpair solve(const ConformalEnergy& energy, const BoundaryForm& form, const ExtendedForm& extended,
                const LinearConstraints& constraints, const Positions& positions, FactorizationBackend backend) {
  ReducedFactor factor = ReducedFactor::of(energy.matrix(), constraints, form, positions, 1e-12, backend, {});
  REQUIRE(factor.is_factored());
  RitzBasis<double> basis;
  const ComplexVector start = starts_of(extended, form, 0, {}).front();
  Eigenpair found = solve_constrained_eigenproblem(factor, energy, extended, {}, start, basis, {});
  // From the solution, the same one.
  const Eigenpair again = solve_constrained_eigenproblem(factor, energy, extended, {}, start, basis, {});
  CHECK((again.converged && again.solves < found.solves));
  CHECK(difference_up_to_similarity(again.vector, found.vector) < 1e-7);
  return found;
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
        const LinearConstraints upright = with_column(energy.n_vertices(), column);
        REQUIRE(upright.n_unknowns() == 2 * energy.n_vertices() - 3);
        const ExtendedForm plain(form);
        const Eigenpair found = solve(energy, form, plain, upright, patch.positions, backend);
        REQUIRE(found.converged);
        CHECK(1 / found.mu == doctest::Approx(dense_reference(energy, plain, upright)).epsilon(1e-7));
        for (const int v : column) CHECK(found.vector[v].real() == found.vector[column[0]].real());
        const LinearConstraints slanted = with_slanted_line(energy.n_vertices(), column);
        const Eigenpair leaning = solve(energy, form, plain, slanted, patch.positions, backend);
        REQUIRE(leaning.converged);
        CHECK(1 / leaning.mu == doctest::Approx(dense_reference(energy, plain, slanted)).epsilon(1e-7));
      }
    }
  }

  TEST_CASE("with extenders, rigid holes and soft pins it is that of the dense problem too") {
    const Patch patch(bumpy_grid(9, 6));
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
    const std::vector<int> column{0, 1, 2, 3};
    const LinearConstraints constraints = with_column(energy.n_vertices(), column);
    const int last = energy.n_vertices() - 1;
    ExtendedForm pushed(form);
    pushed.add_extender({{1}, {last}, 2.0});
    ExtendedForm pulled(form);
    pulled.add_extender({{10}, {last - 9}, -0.05});
    ExtendedForm spread(form);
    spread.add_spread({{10, 11, 17, 18}, Eigen::VectorXd::Ones(4)}, 0.5);
    ExtendedForm attracted(form);
    attracted.add_attraction(pin_attraction({{2, {0, 0}}, {last, {2, 1}}}, form, 30, false));
    for (const ExtendedForm* extended : {&pushed, &pulled, &spread, &attracted}) {
      const Eigenpair found =
          solve(energy, form, *extended, constraints, patch.positions, FactorizationBackend::automatic);
      REQUIRE(found.converged);
      CHECK(1 / found.mu == doctest::Approx(dense_reference(energy, *extended, constraints)).epsilon(1e-7));
      for (const int v : column) CHECK(found.vector[v].real() == found.vector[column[0]].real());
    }
  }

  TEST_CASE("without ties it is the map of Eq. 5, up to a similarity") {
    const Patch patch(bumpy_grid(9, 6));
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
    const Eigenpair found = solve(energy, form, ExtendedForm(form), LinearConstraints::of({}, energy.n_vertices()),
                                  patch.positions, FactorizationBackend::automatic);
    REQUIRE(found.converged);
    CHECK(difference_up_to_similarity(found.vector, conformal_map(patch)) < 1e-8);
  }
}

}  // namespace spectral_conformal::test
