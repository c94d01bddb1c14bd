#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

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
  std::unique_ptr<Factorization> factorization;

  explicit Problem(const Mesh& mesh, FactorizationBackend backend = FactorizationBackend::automatic)
      : patch(mesh),
        energy(patch.energy(Weights::uniform)),
        boundary(boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length)) {
    HermitianMatrix shifted = energy.matrix();
    const double shift = 1e-10 * shifted.coeff(boundary.vertices[0], boundary.vertices[0]).real() / boundary.mass[0];
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
      shifted.coeffRef(boundary.vertices[i], boundary.vertices[i]) += shift * boundary.mass[i];
    }
    factorization = make_factorization(backend, 1000);
    factorization->analyze(shifted);
    REQUIRE(factorization->factorize(shifted));
  }

  Eigenpair solve(const ExtendedForm& form, RitzBasis<Complex>& basis, const Progress& progress = {},
                  const EigenproblemOptions& options = {}) {
    ComplexVector start = ComplexVector::Zero(static_cast<Eigen::Index>(form.support().size()));
    start.head(boundary.mass.size()) = start_vector(boundary, 0);
    return solve_extended_eigenproblem(*factorization, energy, form, options, {start}, basis, progress);
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

void check_against_dense(Problem& problem, const ExtendedForm& form, RitzBasis<Complex>& basis) {
  double expected = 0;
  const ComplexVector reference = dense_reference(problem.energy, form, expected);
  const Eigenpair pair = problem.solve(form, basis);
  REQUIRE(pair.converged);
  CHECK(problem.energy.value(pair.vector) / form.value(form.restrict(pair.vector)) ==
        doctest::Approx(expected).epsilon(1e-8));
  CHECK(difference_up_to_similarity(pair.vector, reference) < 1e-6);
}

}  // namespace

TEST_SUITE_BEGIN("extended_eigenproblem");

TEST_CASE("agrees with the dense pencil, definite or not, from whatever start") {
  for (const auto backend : backends()) {
    Problem problem(perforated_grid(7, 7), backend);
    RitzBasis<Complex> kept;
    for (const double strength : {0.5, 20.0, -0.05, -2.0, -300.0, 0.0}) {
      ExtendedForm form(problem.boundary);
      form.add_extender({{3}, {45}, strength});
      form.add_extender({{12, 13}, {30}, 0.3 * strength});
      RitzBasis<Complex> fresh;
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
    RitzBasis<Complex> basis;
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
  RitzBasis<Complex> basis;
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
  RitzBasis<Complex> basis;
  RitzBasis<Complex> other;
  const Eigenpair pair = problem.solve(form, basis, {}, options);
  CHECK(pair.converged);
  CHECK(pair.solves < 1000);
  CHECK(difference_up_to_similarity(pair.vector, problem.solve(form, other).vector) < 1e-7);
}

TEST_CASE("the same input gives the same output") {
  Problem problem(bumpy_grid(12, 9));
  ExtendedForm form(problem.boundary);
  form.add_extender({{40}, {70}, 1.0});
  RitzBasis<Complex> one;
  RitzBasis<Complex> other;
  CHECK(problem.solve(form, one).vector == problem.solve(form, other).vector);
}

TEST_CASE("the listener can stop it") {
  Problem problem(bumpy_grid(9, 9));
  ExtendedForm form(problem.boundary);
  form.add_extender({{40}, {70}, 1.0});
  RitzBasis<Complex> basis;
  CHECK_THROWS_AS(problem.solve(form, basis, [](double, const char*) { return false; }), Cancelled);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
