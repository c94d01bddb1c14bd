#include <doctest/doctest.h>

#include "conformal/constrained_lscm.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE("constrained_lscm") {
  TEST_CASE("with vertices held and no equations it is pinned LSCM") {
    const Patch patch(bumpy_grid(8, 6));
    const int n = static_cast<int>(patch.positions.rows());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const Pins pins{{0, {-0.5, 0.2}}, {n - 1, {1, 0.9}}, {n / 2, {0.3, -0.7}}};
    LinearEquations equations;
    for (const auto& [vertex, position] : pins) {
      equations.held.emplace_back(2 * vertex, position.real());
      equations.held.emplace_back(2 * vertex + 1, position.imag());
    }
    ConstrainedFactor factor = ConstrainedFactor::of_held(energy, LinearConstraints::of(equations, n), patch.positions,
                                                          FactorizationBackend::automatic, {});
    const PinnedSolution found = solve_constrained_lscm(energy, factor, {});
    PinnedFactor pinned = PinnedFactor::of(energy, pins, FactorizationBackend::automatic, {});
    const PinnedSolution expected = solve_lscm(energy, pins, pinned, {});
    CHECK((found.vector - expected.vector).norm() < 1e-12 * expected.vector.norm());
    CHECK(found.change < 1e-9);
    CHECK(found.residual < 1e-13);
  }

  TEST_CASE("all held: nothing is solved") {
    const Patch patch(bumpy_grid(2, 2));
    const int n = static_cast<int>(patch.positions.rows());
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const ComplexVector flat = flat_map(patch.positions);
    LinearEquations equations;
    for (int v = 0; v < n; ++v) {
      equations.held.emplace_back(2 * v, flat[v].real());
      equations.held.emplace_back(2 * v + 1, flat[v].imag());
    }
    ConstrainedFactor factor = ConstrainedFactor::of_held(energy, LinearConstraints::of(equations, n), patch.positions,
                                                          FactorizationBackend::automatic, {});
    REQUIRE(factor.is_factored());
    CHECK(solve_constrained_lscm(energy, factor, {}).vector == flat);
  }
}

}  // namespace spectral_conformal::test
