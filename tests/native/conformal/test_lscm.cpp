#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#include "conformal/lscm.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

PinnedSolution solved_lscm(const ConformalEnergy& energy, const Pins& pins,
                           FactorizationBackend backend = FactorizationBackend::automatic) {
  PinnedFactor factor = PinnedFactor::of(energy, pins, backend, {});
  return solve_lscm(energy, pins, factor, {});
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
        const PinnedSolution solution = solved_lscm(energy, pins, backend);
        for (const auto& [vertex, position] : pins) CHECK(solution.vector[vertex] == position);
        const ComplexVector gradient = (matrix * solution.vector)(others);
        CHECK(gradient.norm() < 1e-13 * matrix.norm() * solution.vector.norm());
        CHECK(solution.residual < 1e-13);
        CHECK(difference(solution.vector(others), expected) < 1e-10);
      }
    }
  }
}

TEST_CASE("pins of a flat patch that agree with it give the patch back, however far away or small they are") {
  const Patch patch(flat_grid(9, 7));
  const ComplexVector flat = flat_map(patch.positions);
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  for (const Complex origin : {Complex(0), Complex(1e4, -2e4)}) {
    for (const Complex factor : {Complex(0, 1e-6), Complex(2, 1), Complex(-1e6, 3e5)}) {
      const ComplexVector expected = (factor * flat).array() + std::abs(factor) * origin;
      const Pins pins{{3, expected[3]}, {50, expected[50]}};
      const ComplexVector solved = solved_lscm(energy, pins).vector;
      CHECK((solved - expected).norm() < 1e-8 * std::abs(factor) * flat.norm());
    }
  }
}

TEST_CASE("all vertices pinned: nothing to solve") {
  const Mesh triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const Pins pins{{0, 1.0}, {1, {2, 1}}, {2, {0, 5}}};
  const PinnedSolution solution = solved_lscm(Patch(triangle).energy(Weights::uniform), pins);
  for (const auto& [vertex, position] : pins) CHECK(solution.vector[vertex] == position);
}

TEST_CASE("a factor serves all positions of its pinned vertices, with the map of a fresh one") {
  const Patch patch(bumpy_grid(8, 6));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const Pins first{{0, 0.0}, {5, {1, 2}}, {20, {3, 1}}};
  const Pins moved{{0, 1.0}, {5, {2, 2}}, {20, {-3, 1}}};
  PinnedFactor factor = PinnedFactor::of(energy, first, FactorizationBackend::automatic, {});
  CHECK(factor.holds(moved));
  CHECK_FALSE(factor.holds({{0, 0.0}, {5, {1, 2}}}));
  CHECK_FALSE(factor.holds({{0, 0.0}, {5, {1, 2}}, {21, {3, 1}}}));
  solve_lscm(energy, first, factor, {});
  CHECK(solve_lscm(energy, moved, factor, {}).vector == solved_lscm(energy, moved).vector);
}

TEST_CASE("a free part that is singular is a failure, not a result") {
  Patch patch(flat_grid(2, 2));
  Positions with_stray_vertex(patch.positions.rows() + 1, 3);
  with_stray_vertex << patch.positions, Eigen::RowVector3d(5, 5, 5);
  const ConformalEnergy energy =
      conformal_energy(with_stray_vertex, patch.chart.triangles, patch.chart.triangle_weights, Weights::uniform);
  for (const auto backend : backends()) {
    CHECK_FALSE(PinnedFactor::of(energy, {{0, 0.0}, {1, 1.0}}, backend, {}).is_factorized());
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
