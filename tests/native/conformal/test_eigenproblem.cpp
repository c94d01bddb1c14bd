#include <Spectra/MatOp/DenseCholesky.h>
#include <Spectra/MatOp/DenseSymMatProd.h>
#include <Spectra/SymGEigsSolver.h>
#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "conformal/eigenproblem.h"
#include "meshes.h"

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

std::vector<BoundaryForm> forms(const Patch& patch) {
  return {boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length),
          boundary_form(patch.outer(), patch.positions, BoundaryMeasure::vertex),
          identity_form(static_cast<int>(patch.positions.rows()))};
}

struct Problem {
  Patch patch;
  ConformalEnergy energy;
  BoundaryForm mass;
  ReducedFactor factor;

  explicit Problem(const Mesh& mesh, FactorizationBackend backend = FactorizationBackend::automatic,
                   double relative_shift = 1e-14)
      : Problem(Patch(mesh), Weights::uniform, 0, backend, relative_shift) {}
  /// form: index into `forms`.
  Problem(Patch of, Weights weights, int form, FactorizationBackend backend, double relative_shift)
      : patch(std::move(of)),
        energy(patch.energy(weights)),
        mass(forms(patch)[form]),
        factor(ReducedFactor::of(energy.matrix(), std::nullopt, mass, patch.positions, relative_shift, backend, {})) {
    REQUIRE(factor.is_factored());
  }

  Eigenvector solve(const QuotientForm& form, EarlierBasis& basis, const Progress& progress = {},
                    const EigenproblemOptions& options = {}) {
    return smallest_eigenvector(factor, energy, form, mass, options, basis, {}, progress);
  }
  Eigenvector solve(const EigenproblemOptions& options = {}, const Progress& progress = {}) {
    EarlierBasis none;
    return solve(QuotientForm(mass), none, progress, options);
  }
};

Eigen::MatrixXcd matrix_of(const QuotientForm& form, Eigen::Index n) {
  Eigen::MatrixXcd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    ComplexVector column = ComplexVector::Zero(n);
    form.add_applied(ComplexVector::Unit(n, j), 1, column);
    result.col(j) = column;
  }
  return 0.5 * (result + result.adjoint());
}

/// L + 1 1^T, which is definite and the same on all that is orthogonal to the constants, which both forms ignore.
Eigen::MatrixXcd definite(const ConformalEnergy& energy) {
  return dense(energy.matrix()) + Eigen::MatrixXcd::Ones(energy.n_vertices(), energy.n_vertices());
}

/// The eigenvector of the largest mu of B z = mu L z by dense algebra.
ComplexVector dense_reference(const ConformalEnergy& energy, const QuotientForm& form, double& lambda) {
  const Eigen::Index n = energy.n_vertices();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(matrix_of(form, n), definite(energy));
  lambda = 1 / solver.eigenvalues()[n - 1];
  return solver.eigenvectors().col(n - 1);
}

void check_against_dense(Problem& problem, const QuotientForm& form, EarlierBasis& basis) {
  double expected = 0;
  const ComplexVector reference = dense_reference(problem.energy, form, expected);
  const Eigenvector v = problem.solve(form, basis);
  REQUIRE(v.converged);
  CHECK(v.lambda == doctest::Approx(problem.energy.value(v.z) / form.value_of_map(v.z)));
  CHECK(v.lambda == doctest::Approx(expected).epsilon(1e-8));
  CHECK(difference_up_to_similarity(v.z, reference) < 1e-6);
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
double constrained_reference(const ConformalEnergy& energy, const QuotientForm& form,
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

Eigenvector solve_constrained(const ConformalEnergy& energy, const BoundaryForm& mass, const QuotientForm& form,
                              const LinearConstraints& constraints, const Positions& positions,
                              FactorizationBackend backend) {
  ReducedFactor factor = ReducedFactor::of(energy.matrix(), constraints, mass, positions, 1e-14, backend, {});
  REQUIRE(factor.is_factored());
  EarlierBasis basis;
  Eigenvector found = smallest_eigenvector(factor, energy, form, mass, {}, basis, {}, {});
  // From the solution, the same one.
  const Eigenvector again = smallest_eigenvector(factor, energy, form, mass, {}, basis, {}, {});
  CHECK((again.converged && again.solves < found.solves));
  CHECK(difference_up_to_similarity(again.z, found.z) < 1e-7);
  return found;
}

}  // namespace

TEST_SUITE_BEGIN("eigenproblem");

TEST_CASE("agrees with a dense generalized eigendecomposition, whatever the shift") {
  // From one triangle to patches with holes.
  const Mesh triangle({{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0.3}, {0.5, 0.4, 0.8}}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  for (const auto& mesh : {triangle, bumpy_grid(3, 3), bumpy_grid(9, 7), perforated_grid(10, 10)}) {
    const Patch patch(mesh);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      for (int form = 0; form < 3; ++form) {
        const Reference reference = dense_reference(patch.energy(weights).matrix(), forms(patch)[form]);
        REQUIRE(reference.next > 1.01 * reference.eigenvalue);
        for (const auto backend : backends()) {
          for (const double shift : {1e-14, 1e-6, 1e-2}) {
            const Eigenvector v = Problem(Patch(mesh), weights, form, backend, shift).solve();
            REQUIRE(v.converged);
            CHECK((v.change < v.change_limit && v.residual < EigenproblemOptions().tolerance && v.solves > 0));
            CHECK(v.lambda == doctest::Approx(reference.eigenvalue).epsilon(1e-8));
            CHECK(difference_up_to_similarity(v.z, reference.vector) < 1e-7);
          }
        }
      }
    }
  }
}

TEST_CASE("agrees with Spectra, on coordinates instead of complex numbers") {
  Problem problem(bumpy_grid(20, 15));
  const QuotientForm form(problem.mass);
  const Eigen::Index n = problem.energy.n_vertices();
  const Eigen::MatrixXd b = on_coordinates(matrix_of(form, n));
  const Eigen::MatrixXd l = on_coordinates(definite(problem.energy));
  Spectra::DenseSymMatProd<double> product(b);
  Spectra::DenseCholesky<double> factor(l);
  using Solver = Spectra::SymGEigsSolver<Spectra::DenseSymMatProd<double>, Spectra::DenseCholesky<double>,
                                         Spectra::GEigsMode::Cholesky>;
  Solver solver(product, factor, 2, 20);
  solver.init();
  REQUIRE(solver.compute(Spectra::SortRule::LargestAlge, 1000, 1e-12) == 2);
  const Eigen::VectorXd coordinates = solver.eigenvectors().col(0);
  ComplexVector reference(n);
  for (Eigen::Index v = 0; v < n; ++v) reference(v) = Complex(coordinates(2 * v), coordinates(2 * v + 1));
  const Eigenvector found = problem.solve();
  REQUIRE(found.converged);
  CHECK(found.lambda == doctest::Approx(1 / solver.eigenvalues()[0]).epsilon(1e-9));
  CHECK(difference_up_to_similarity(found.z, reference) < 1e-6);
}

TEST_CASE("the same input gives the same output, and another start the same map") {
  Problem problem(bumpy_grid(12, 9));
  EigenproblemOptions options;
  const Eigenvector first = problem.solve();
  CHECK(problem.solve().z == first.z);
  options.start = 1;
  const Eigenvector other = problem.solve(options);
  CHECK(other.z != first.z);
  CHECK(difference_up_to_similarity(other.z, first.z) < 1e-7);
}

TEST_CASE("on a flat strip, most of whose eigenvalues lie below the shift, the map is the strip") {
  Mesh mesh = flat_grid(6001, 3);
  for (Eigen::Vector3d& point : mesh.points) point /= 6000;
  for (const double shift : {1e-14, 1e-12}) {
    Problem problem(mesh, FactorizationBackend::automatic, shift);
    const Eigenvector v = problem.solve();
    REQUIRE(v.converged);
    CHECK(v.solves <= 16);
    CHECK(difference_up_to_similarity(v.z, flat_map(problem.patch.positions)) < 1e-8);
  }
}

TEST_CASE("B = A: agrees with the dense pencil") {
  for (const auto& mesh : {bumpy_grid(5, 4), perforated_grid(7, 7)}) {
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      for (const auto backend : backends()) {
        Problem problem(Patch(mesh), weights, 0, backend, 1e-14);
        EarlierBasis none;
        check_against_dense(problem, QuotientForm::area(problem.energy), none);
      }
    }
  }
}

TEST_CASE("a form that is positive for nothing has no map") {
  Problem problem(bumpy_grid(9, 8));
  QuotientForm negative(problem.mass);
  negative.add_spread(problem.mass, -2);
  EarlierBasis none;
  CHECK_FALSE(problem.solve(negative, none).converged);
}

TEST_CASE("solves are bounded: what did not converge says so") {
  Problem problem(Patch(perforated_grid(16, 16)), Weights::uniform, 2, FactorizationBackend::automatic, 1e-14);
  EigenproblemOptions options;
  options.max_solves = 3;
  const Eigenvector v = problem.solve(options);
  CHECK_FALSE(v.converged);
  CHECK(v.solves < 6);
}

TEST_CASE("an exception of the listener passes through, a std::runtime_error too") {
  Problem problem(bumpy_grid(12, 9));
  for (const int fails_at : {2, 4}) {
    int calls = 0;
    const Progress listener = [&](double, const char*) {
      if (++calls == fails_at) throw std::runtime_error("the listener's own");
      return true;
    };
    CHECK_THROWS_WITH_AS(problem.solve({}, listener), "the listener's own", std::runtime_error);
  }
}

TEST_CASE("agrees with the dense pencil, definite or not, from whatever start") {
  for (const auto backend : backends()) {
    Problem problem(perforated_grid(7, 7), backend);
    EarlierBasis kept;
    for (const double strength : {0.5, 20.0, -0.05, -2.0, -300.0, 0.0}) {
      QuotientForm form(problem.mass);
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
    QuotientForm form(problem.mass);
    form.add_attraction(pin_attraction(pins, problem.mass, strength));
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
  QuotientForm first(problem.mass);
  first.add_extender({{40}, {700}, 1.0});
  const int from_nothing = problem.solve(first, basis).solves;
  QuotientForm second(problem.mass);
  second.add_extender({{40}, {700}, 1.01});
  CHECK(problem.solve(second, basis).solves < from_nothing);
}

TEST_CASE("a tolerance that rounding does not allow ends where nothing is gained any more") {
  // Found by fuzzing: 4800 solves in a space of 96 vectors took a minute on 174 vertices.
  Problem problem(bumpy_grid(12, 9));
  QuotientForm form(problem.mass);
  form.add_extender({{40}, {70}, 1.0});
  EigenproblemOptions options;
  options.tolerance = 1e-18;
  EarlierBasis basis;
  EarlierBasis other;
  const Eigenvector v = problem.solve(form, basis, {}, options);
  CHECK(v.converged);
  CHECK(v.solves < 1000);
  CHECK(difference_up_to_similarity(v.z, problem.solve(form, other).z) < 1e-7);
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
      const QuotientForm plain(form);
      const Eigenvector found = solve_constrained(energy, form, plain, upright, patch.positions, backend);
      REQUIRE(found.converged);
      CHECK(found.lambda == doctest::Approx(constrained_reference(energy, plain, upright)).epsilon(1e-7));
      for (const int v : column) CHECK(found.z[v].real() == found.z[column[0]].real());
      const LinearConstraints slanted = with_slanted_line(energy.n_vertices(), column);
      const Eigenvector leaning = solve_constrained(energy, form, plain, slanted, patch.positions, backend);
      REQUIRE(leaning.converged);
      CHECK(leaning.lambda == doctest::Approx(constrained_reference(energy, plain, slanted)).epsilon(1e-7));
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
  QuotientForm pushed(form);
  pushed.add_extender({{1}, {last}, 2.0});
  QuotientForm pulled(form);
  pulled.add_extender({{10}, {last - 9}, -0.05});
  QuotientForm spread(form);
  spread.add_spread({{10, 11, 17, 18}, Eigen::VectorXd::Ones(4)}, 0.5);
  QuotientForm attracted(form);
  attracted.add_attraction(pin_attraction({{2, {0, 0}}, {last, {2, 1}}}, form, 30, false));
  for (const QuotientForm* extended : {&pushed, &pulled, &spread, &attracted}) {
    const Eigenvector found =
        solve_constrained(energy, form, *extended, constraints, patch.positions, FactorizationBackend::automatic);
    REQUIRE(found.converged);
    CHECK(found.lambda == doctest::Approx(constrained_reference(energy, *extended, constraints)).epsilon(1e-7));
    for (const int v : column) CHECK(found.z[v].real() == found.z[column[0]].real());
  }
}

TEST_CASE("without ties it is the map of Eq. 5, up to a similarity") {
  const Patch patch(bumpy_grid(9, 6));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const BoundaryForm form = boundary_form(patch.outer(), patch.positions, BoundaryMeasure::length);
  const Eigenvector found =
      solve_constrained(energy, form, QuotientForm(form), LinearConstraints::of({}, energy.n_vertices()),
                        patch.positions, FactorizationBackend::automatic);
  REQUIRE(found.converged);
  CHECK(difference_up_to_similarity(found.z, conformal_map(patch)) < 1e-8);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
