#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#include "conformal/lscm.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

LinearConstraints held(const Pins& pins, int n_vertices) {
  LinearEquations equations;
  for (const auto& [vertex, position] : pins) {
    equations.held.emplace_back(2 * vertex, position.real());
    equations.held.emplace_back(2 * vertex + 1, position.imag());
  }
  return LinearConstraints::of(equations, n_vertices);
}

LscmSolution solved_lscm(const Patch& patch, const ConformalEnergy& energy, const Pins& pins,
                         FactorizationBackend backend = FactorizationBackend::automatic) {
  ReducedFactor factor = ReducedFactor::of_held(energy, held(pins, energy.n_vertices()), patch.positions, backend, {});
  REQUIRE(factor.is_factored());
  return solve_lscm(energy, factor, {});
}

}  // namespace

TEST_SUITE_BEGIN("lscm");

TEST_CASE("pins are exact, the gradient vanishes at the free vertices, and a dense solve agrees") {
  for (const auto& mesh : {bumpy_grid(8, 6), perforated_grid(10, 7)}) {
    const Patch patch(mesh);
    const int n = static_cast<int>(patch.positions.rows());
    const Pins pins{{0, {0.1, 0.2}}, {n - 1, {3.7, 2.9}}, {n / 2, {1.3, 2.2}}};
    const std::vector<int> pinned{0, n / 2, n - 1};
    std::vector<int> others;
    ComplexVector positions(3);
    for (int v = 0; v < n; ++v) {
      if (pins.count(v) == 0) others.push_back(v);
    }
    for (int k = 0; k < 3; ++k) positions[k] = pins.at(pinned[k]);
    for (const auto weights : {Weights::uniform, Weights::inverse_area}) {
      const ConformalEnergy energy = patch.energy(weights);
      const Eigen::MatrixXcd matrix = dense(energy.matrix());
      const Eigen::MatrixXcd inner = matrix(others, others);
      const Eigen::MatrixXcd outer = matrix(others, pinned);
      const ComplexVector expected = -inner.llt().solve(outer * positions);
      for (const auto backend : backends()) {
        const LscmSolution solution = solved_lscm(patch, energy, pins, backend);
        for (const auto& [vertex, position] : pins) CHECK(solution.vector[vertex] == position);
        const ComplexVector gradient = (matrix * solution.vector)(others);
        CHECK(gradient.norm() < 1e-13 * matrix.norm() * solution.vector.norm());
        CHECK(solution.residual < 1e-13);
        CHECK(difference(solution.vector(others), expected) < 1e-10);
      }
    }
  }
}

TEST_CASE("pins of a flat patch that agree with it give the patch back, however large or small they are") {
  const Patch patch(flat_grid(9, 7));
  const ComplexVector flat = flat_map(patch.positions);
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  for (const Complex factor : {Complex(0, 1e-6), Complex(2, 1), Complex(-1e6, 3e5)}) {
    const ComplexVector expected = factor * flat;
    const ComplexVector solved = solved_lscm(patch, energy, {{3, expected[3]}, {50, expected[50]}}).vector;
    CHECK((solved - expected).norm() < 1e-10 * expected.norm());
  }
}

TEST_CASE("all vertices pinned: nothing to solve") {
  const Patch patch(Mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
  const Pins pins{{0, 1.0}, {1, {2, 1}}, {2, {0, 5}}};
  const LscmSolution solution = solved_lscm(patch, patch.energy(Weights::uniform), pins);
  for (const auto& [vertex, position] : pins) CHECK(solution.vector[vertex] == position);
  CHECK(solution.change == 0);
}

TEST_CASE("a factor serves all positions of its pinned vertices, with the map of a fresh one") {
  const Patch patch(bumpy_grid(8, 6));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const int n = energy.n_vertices();
  const Pins first{{0, 0.0}, {5, {1, 2}}, {20, {3, 1}}};
  const Pins moved{{0, 1.0}, {5, {2, 2}}, {20, {-3, 1}}};
  ReducedFactor factor =
      ReducedFactor::of_held(energy, held(first, n), patch.positions, FactorizationBackend::automatic, {});
  CHECK(factor.serves(held(moved, n)));
  CHECK_FALSE(factor.serves(held({{0, 0.0}, {5, {1, 2}}}, n)));
  CHECK_FALSE(factor.serves(held({{0, 0.0}, {5, {1, 2}}, {21, {3, 1}}}, n)));
  solve_lscm(energy, factor, {});
  factor.adopt(held(moved, n));
  CHECK(solve_lscm(energy, factor, {}).vector == solved_lscm(patch, energy, moved).vector);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
