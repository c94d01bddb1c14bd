#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "conformal/extended_eigenproblem.h"
#include "conformal/start_vector.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

struct Problem {
  Patch patch;
  ConformalEnergy energy;
  BoundaryForm boundary;
  ReducedFactor factor;

  explicit Problem(const Mesh& mesh, FactorizationBackend backend = FactorizationBackend::automatic)
      : patch(mesh),
        energy(patch.energy(Weights::uniform)),
        boundary(boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length)),
        factor(ReducedFactor::of_free(energy.matrix(), boundary, patch.positions, 1e-10, backend, {})) {
    REQUIRE(factor.is_factored());
  }

  Eigenpair solve(const ExtendedForm& form, EarlierBasis& basis, const Progress& progress = {},
                  const EigenproblemOptions& options = {}) {
    ComplexVector start = ComplexVector::Zero(static_cast<Eigen::Index>(form.support().size()));
    start.head(boundary.mass.size()) = start_vector(boundary, 0);
    return solve_extended_eigenproblem(factor, energy, form, options, {start}, basis, progress);
  }
};

/// The eigenvector of the largest mu of B z = mu L z by dense algebra.
ComplexVector dense_reference(const ConformalEnergy& energy, const ExtendedForm& form, double& lambda) {
  const Eigen::Index n = energy.n_vertices();
  Eigen::MatrixXcd matrix(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    ComplexVector column = ComplexVector::Zero(n);
    form.add_applied(ComplexVector::Unit(n, j), 1, column);
    matrix.col(j) = column;
  }
  // 1 1^T makes L definite without touching what is orthogonal to the constants, which both forms ignore.
  const Eigen::MatrixXcd definite = dense(energy.matrix()) + Eigen::MatrixXcd::Ones(n, n);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(0.5 * (matrix + matrix.adjoint()), definite);
  lambda = 1 / solver.eigenvalues()[n - 1];
  return solver.eigenvectors().col(n - 1);
}

void check_against_dense(Problem& problem, const ExtendedForm& form, EarlierBasis& basis) {
  double expected = 0;
  const ComplexVector reference = dense_reference(problem.energy, form, expected);
  const Eigenpair pair = problem.solve(form, basis);
  REQUIRE(pair.converged);
  CHECK(problem.energy.value(pair.vector) / form.value(form.restrict(pair.vector)) ==
        doctest::Approx(expected).epsilon(1e-8));
  CHECK(difference_up_to_similarity(pair.vector, reference) < 1e-6);
}

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
double constrained_reference(const ConformalEnergy& energy, const ExtendedForm& form,
                             const LinearConstraints& constraints) {
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

Eigenpair solve_constrained(const ConformalEnergy& energy, const BoundaryForm& form, const ExtendedForm& extended,
                            const LinearConstraints& constraints, const Positions& positions,
                            FactorizationBackend backend) {
  ReducedFactor factor = ReducedFactor::of(energy.matrix(), constraints, form, positions, 1e-12, backend, {});
  REQUIRE(factor.is_factored());
  EarlierBasis basis;
  const ComplexVector start = starts_of(extended, form, 0, {}).front();
  Eigenpair found = solve_extended_eigenproblem(factor, energy, extended, {}, {start}, basis, {});
  // From the solution, the same one.
  const Eigenpair again = solve_extended_eigenproblem(factor, energy, extended, {}, {start}, basis, {});
  CHECK((again.converged && again.solves < found.solves));
  CHECK(difference_up_to_similarity(again.vector, found.vector) < 1e-7);
  return found;
}

}  // namespace

TEST_SUITE_BEGIN("extended_eigenproblem");

TEST_CASE("agrees with the dense pencil, definite or not, from whatever start") {
  for (const auto backend : backends()) {
    Problem problem(perforated_grid(7, 7), backend);
    EarlierBasis kept;
    for (const double strength : {0.5, 20.0, -0.05, -2.0, -300.0, 0.0}) {
      ExtendedForm form(problem.boundary);
      form.add_extender({{3}, {45}, strength});
      form.add_extender({{12, 13}, {30}, 0.3 * strength});
      EarlierBasis fresh;
      check_against_dense(problem, form, fresh);
      check_against_dense(problem, form, kept);
    }
  }
}

TEST_CASE("attracting pins and rigid holes: agrees with the dense pencil") {
  Problem problem(perforated_grid(7, 7));
  const Pins pins{{0, {0, 0}}, {7, {8, 1}}, {20, {4, 5}}, {29, {3, 2}}, {47, {9, 6}}};
  for (const double strength : {0.1, 10.0, 1000.0}) {
    ExtendedForm form(problem.boundary);
    form.add_attraction(pin_attraction(pins, problem.boundary, strength));
    EarlierBasis basis;
    check_against_dense(problem, form, basis);
    for (const BoundaryLoop& loop : problem.patch.chart.boundary_loops) {
      if (loop.size() == problem.patch.outer().size()) continue;
      form.add_spread(boundary_form(loop, problem.patch.positions, BoundaryMeasure::length), 0.01 * strength);
    }
    check_against_dense(problem, form, basis);
  }
}

TEST_CASE("a solve that starts from the last one takes fewer solves") {
  Problem problem(bumpy_grid(30, 25));
  EarlierBasis basis;
  ExtendedForm first(problem.boundary);
  first.add_extender({{40}, {700}, 1.0});
  const int from_nothing = problem.solve(first, basis).solves;
  ExtendedForm second(problem.boundary);
  second.add_extender({{40}, {700}, 1.01});
  CHECK(problem.solve(second, basis).solves < from_nothing);
}

TEST_CASE("a tolerance that rounding does not allow ends where nothing is gained any more") {
  // Found by fuzzing: 4800 solves in a space of 96 vectors took a minute on 174 vertices.
  Problem problem(bumpy_grid(12, 9));
  ExtendedForm form(problem.boundary);
  form.add_extender({{40}, {70}, 1.0});
  EigenproblemOptions options;
  options.tolerance = 1e-18;
  options.krylov_dimension = 24;
  EarlierBasis basis;
  EarlierBasis other;
  const Eigenpair pair = problem.solve(form, basis, {}, options);
  CHECK(pair.converged);
  CHECK(pair.solves < 1000);
  CHECK(difference_up_to_similarity(pair.vector, problem.solve(form, other).vector) < 1e-7);
}

TEST_CASE("the same input gives the same output") {
  Problem problem(bumpy_grid(12, 9));
  ExtendedForm form(problem.boundary);
  form.add_extender({{40}, {70}, 1.0});
  EarlierBasis one;
  EarlierBasis other;
  CHECK(problem.solve(form, one).vector == problem.solve(form, other).vector);
}

TEST_CASE("the listener can stop it") {
  Problem problem(bumpy_grid(9, 9));
  ExtendedForm form(problem.boundary);
  form.add_extender({{40}, {70}, 1.0});
  EarlierBasis basis;
  CHECK_THROWS_AS(problem.solve(form, basis, [](double, const char*) { return false; }), Cancelled);
}

TEST_CASE("under equations the eigenvalue is that of the dense problem, and the map meets the constraints") {
  for (const FactorizationBackend backend : backends()) {
    for (const int columns : {3, 12}) {
      const Patch patch(bumpy_grid(columns, 5));
      const ConformalEnergy energy = patch.energy(Weights::uniform);
      const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
      const std::vector<int> column{0, 1, 2, 3};
      const LinearConstraints upright = with_column(energy.n_vertices(), column);
      REQUIRE(upright.n_unknowns() == 2 * energy.n_vertices() - 3);
      const ExtendedForm plain(form);
      const Eigenpair found = solve_constrained(energy, form, plain, upright, patch.positions, backend);
      REQUIRE(found.converged);
      CHECK(1 / found.mu == doctest::Approx(constrained_reference(energy, plain, upright)).epsilon(1e-7));
      for (const int v : column) CHECK(found.vector[v].real() == found.vector[column[0]].real());
      const LinearConstraints slanted = with_slanted_line(energy.n_vertices(), column);
      const Eigenpair leaning = solve_constrained(energy, form, plain, slanted, patch.positions, backend);
      REQUIRE(leaning.converged);
      CHECK(1 / leaning.mu == doctest::Approx(constrained_reference(energy, plain, slanted)).epsilon(1e-7));
    }
  }
}

TEST_CASE("under equations with extenders, rigid holes and soft pins it is that of the dense problem too") {
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
        solve_constrained(energy, form, *extended, constraints, patch.positions, FactorizationBackend::automatic);
    REQUIRE(found.converged);
    CHECK(1 / found.mu == doctest::Approx(constrained_reference(energy, *extended, constraints)).epsilon(1e-7));
    for (const int v : column) CHECK(found.vector[v].real() == found.vector[column[0]].real());
  }
}

TEST_CASE("without ties it is the map of Eq. 5, up to a similarity") {
  const Patch patch(bumpy_grid(9, 6));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const Eigenpair found =
      solve_constrained(energy, form, ExtendedForm(form), LinearConstraints::of({}, energy.n_vertices()),
                        patch.positions, FactorizationBackend::automatic);
  REQUIRE(found.converged);
  CHECK(difference_up_to_similarity(found.vector, conformal_map(patch)) < 1e-8);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
