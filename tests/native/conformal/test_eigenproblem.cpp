#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "conformal/eigenproblem.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

struct Reference {
  double eigenvalue;
  double next;
  ComplexVector vector;  ///< on all vertices
};

/// Smallest nonzero eigenvalue of L z = lambda M z after dense elimination of the vertices without mass: the
/// eigenvectors with lambda > 0 are M-orthogonal to the constants, where B^ = M.
Reference dense_reference(const HermitianMatrix& energy, const BoundaryForm& form) {
  const Eigen::MatrixXcd matrix = dense(energy);
  std::vector<char> has_mass(static_cast<std::size_t>(matrix.cols()), 0);
  for (const int v : form.vertices) has_mass[v] = 1;
  std::vector<int> massless;
  for (int v = 0; v < matrix.cols(); ++v) {
    if (!has_mass[v]) massless.push_back(v);
  }
  Eigen::MatrixXcd schur = matrix(form.vertices, form.vertices);
  Eigen::MatrixXcd extension(massless.size(), form.vertices.size());
  if (!massless.empty()) {
    extension = -matrix(massless, massless).llt().solve(Eigen::MatrixXcd(matrix(massless, form.vertices)));
    schur += matrix(form.vertices, massless) * extension;
  }
  const Eigen::MatrixXcd mass = form.mass.cast<Complex>().asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(0.5 * (schur + schur.adjoint()), mass);
  Reference result{solver.eigenvalues()[1], solver.eigenvalues()[2], ComplexVector(matrix.cols())};
  const ComplexVector on_mass = solver.eigenvectors().col(1);
  result.vector(form.vertices) = on_mass;
  result.vector(massless) = extension * on_mass;
  return result;
}

ReducedFactor factored_form(const Patch& patch, const ConformalEnergy& energy, const BoundaryForm& form,
                            FactorizationBackend backend, double relative) {
  ReducedFactor factor = ReducedFactor::of_free(energy.matrix(), form, patch.positions, relative, backend, {});
  REQUIRE(factor.is_factored());
  return factor;
}

std::vector<BoundaryForm> forms(const Patch& patch) {
  return {boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length),
          boundary_form(patch.outer(), patch.positions, BoundaryMeasure::vertex),
          identity_form(static_cast<int>(patch.positions.rows()))};
}

}  // namespace

TEST_SUITE_BEGIN("eigenproblem");

TEST_CASE("agrees with a dense generalized eigendecomposition") {
  // From one triangle to patches with holes, below and above the size that is solved densely.
  const Mesh triangle({{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0.3}, {0.5, 0.4, 0.8}}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  for (const auto& mesh : {triangle, bumpy_grid(3, 3), bumpy_grid(9, 7), perforated_grid(10, 10)}) {
    const Patch patch(mesh);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      const ConformalEnergy energy = patch.energy(weights);
      for (const BoundaryForm& form : forms(patch)) {
        const Reference reference = dense_reference(energy.matrix(), form);
        REQUIRE(reference.next > 1.01 * reference.eigenvalue);
        for (const auto backend : backends()) {
          ReducedFactor factored = factored_form(patch, energy, form, backend, 1e-10);
          const Eigenpair pair = solve_eigenproblem(factored.factorization(), form, {}, {});
          REQUIRE(pair.converged);
          CHECK(pair.residual < 1e-6);
          CHECK(1 / pair.mu - factored.shift() == doctest::Approx(reference.eigenvalue).epsilon(1e-6));
          CHECK(energy.value(pair.vector) / form.value(pair.vector) ==
                doctest::Approx(reference.eigenvalue).epsilon(1e-8));
          CHECK(difference_up_to_similarity(pair.vector, reference.vector) < 1e-5);
        }
      }
    }
  }
}

TEST_CASE("the shift does not change the eigenvector") {
  const Patch patch(perforated_grid(10, 10));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = forms(patch).front();
  const Reference reference = dense_reference(energy.matrix(), form);
  for (const double relative : {1e-10, 1e-6, 1e-2}) {
    ReducedFactor factored = factored_form(patch, energy, form, FactorizationBackend::automatic, relative);
    EigenproblemOptions options;
    options.tolerance = 1e-12;
    const Eigenpair pair = solve_eigenproblem(factored.factorization(), form, options, {});
    CHECK(difference_up_to_similarity(pair.vector, reference.vector) < 1e-6);
    CHECK(1 / pair.mu - factored.shift() == doctest::Approx(reference.eigenvalue).epsilon(1e-6));
  }
}

TEST_CASE("the same input gives the same output, and another start the same map") {
  const Patch patch(bumpy_grid(12, 9));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = forms(patch).front();
  ReducedFactor factored = factored_form(patch, energy, form, FactorizationBackend::automatic, 1e-10);
  EigenproblemOptions options;
  const Eigenpair first = solve_eigenproblem(factored.factorization(), form, options, {});
  CHECK(solve_eigenproblem(factored.factorization(), form, options, {}).vector == first.vector);
  options.start = 1;
  const Eigenpair other = solve_eigenproblem(factored.factorization(), form, options, {});
  CHECK(other.vector != first.vector);
  CHECK(difference_up_to_similarity(other.vector, first.vector) < 1e-5);
}

TEST_CASE("B = A: agrees with the dense pencil") {
  for (const auto& mesh : {bumpy_grid(5, 4), perforated_grid(7, 7)}) {
    const Patch patch(mesh);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      const ConformalEnergy energy = patch.energy(weights);
      const Eigen::MatrixXcd matrix = dense(energy.matrix());
      const Eigen::Index n = matrix.cols();
      const Eigen::MatrixXcd area = matrix.imag().cast<Complex>() * Complex(0, -1);
      // 1 1^T makes L definite without touching what is orthogonal to the constants, which both forms ignore.
      const Eigen::MatrixXcd definite = matrix + Eigen::MatrixXcd::Ones(n, n);
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(area, definite);
      const double expected = 1 / solver.eigenvalues()[n - 1];
      for (const auto backend : backends()) {
        const BoundaryForm form = forms(patch).front();
        ReducedFactor factored = factored_form(patch, energy, form, backend, 1e-10);
        const Eigenpair pair = solve_area_eigenproblem(factored, energy, form, {}, {});
        REQUIRE(pair.converged);
        CHECK(energy.value(pair.vector) / energy.area_form(pair.vector) == doctest::Approx(expected).epsilon(1e-7));
        CHECK(difference_up_to_similarity(pair.vector, solver.eigenvectors().col(n - 1)) < 1e-5);
      }
    }
  }
}

TEST_CASE("iterations are bounded: what did not converge says so") {
  const Patch patch(perforated_grid(16, 16));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = forms(patch)[2];
  ReducedFactor factored = factored_form(patch, energy, form, FactorizationBackend::automatic, 1e-10);
  EigenproblemOptions options;
  options.max_restarts = 1;
  options.krylov_dimension = 3;
  options.tolerance = 1e-15;
  const Eigenpair pair = solve_eigenproblem(factored.factorization(), form, options, {});
  CHECK_FALSE(pair.converged);
  CHECK(pair.solves < 10);
}

TEST_CASE("an exception of the listener passes through, a std::runtime_error too") {
  // Spectra reports its own failures as std::runtime_error: every such exception was taken for one of them.
  const Patch patch(bumpy_grid(12, 9));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  ReducedFactor factored = factored_form(patch, energy, form, FactorizationBackend::automatic, 1e-10);
  for (const int fails_at : {2, 4}) {
    int calls = 0;
    const Progress listener = [&](double, const char*) {
      if (++calls == fails_at) throw std::runtime_error("the listener's own");
      return true;
    };
    CHECK_THROWS_WITH_AS(solve_eigenproblem(factored.factorization(), form, {}, listener), "the listener's own",
                         std::runtime_error);
    calls = 0;
    CHECK_THROWS_WITH_AS(solve_area_eigenproblem(factored, energy, form, {}, listener), "the listener's own",
                         std::runtime_error);
  }
}

TEST_CASE("the listener can stop it") {
  const Patch patch(bumpy_grid(9, 9));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = forms(patch).front();
  ReducedFactor factored = factored_form(patch, energy, form, FactorizationBackend::automatic, 1e-10);
  const Progress stop = [](double, const char*) { return false; };
  CHECK_THROWS_AS(solve_eigenproblem(factored.factorization(), form, {}, stop), Cancelled);
  CHECK_THROWS_AS(solve_area_eigenproblem(factored, energy, form, {}, stop), Cancelled);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
