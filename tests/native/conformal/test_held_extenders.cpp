#include <doctest/doctest.h>

#include "conformal/held_extenders.h"
#include "conformal/lscm.h"
#include "meshes.h"

namespace spectral_conformal::test {

TEST_SUITE("held_extenders") {
  TEST_CASE("a push is the stationary map of a reduced stiffness, and pulls take their part of the distance") {
    const Patch patch(bumpy_grid(8, 6));
    const ConformalEnergy energy = patch.energy(Weights::uniform);
    const int n = energy.n_vertices();
    const Pins pins{{0, {-0.5, 0.2}}, {n - 1, {1, 0.9}}, {n / 2, {0.3, -0.7}}};
    LinearEquations equations;
    for (const auto& [vertex, position] : pins) {
      equations.held.emplace_back(2 * vertex, position.real());
      equations.held.emplace_back(2 * vertex + 1, position.imag());
    }
    ReducedFactor factor = ReducedFactor::of_held(energy, LinearConstraints::of(equations, n), patch.positions,
                                                  FactorizationBackend::automatic, {});
    const ComplexVector plain = solve_lscm(energy, factor, {}).vector;
    const auto inverse = [&](const ComplexVector& force) { return lscm_response(energy, force, factor, {}).vector; };
    const auto moved = [&](const std::vector<Extender>& extenders, bool may_turn) {
      ComplexVector z = plain;
      push_and_pull(extenders, inverse, may_turn, energy.max_diagonal(), z);
      return z;
    };
    const std::vector<int> from{3};
    const std::vector<int> to{20, 40};
    const auto distance = [&](const ComplexVector& z) { return z[3] - 0.5 * (z[20] + z[40]); };
    const ComplexVector pushed = moved({{from, to, 0.7}}, true);
    CHECK(std::abs(distance(pushed) - 1.7 * distance(plain)) < 1e-12);
    CHECK(std::abs(distance(moved({{from, to, -3.0}}, true)) - 0.25 * distance(plain)) < 1e-12);
    for (const auto& [vertex, position] : pins) CHECK(pushed[vertex] == position);
    // Twice the same pull is one of the sum; pushes add up.
    CHECK(difference(moved({{from, to, -1.0}, {to, from, -2.0}}, true), moved({{from, to, -3.0}}, true)) < 1e-12);
    CHECK(difference(moved({{from, to, 0.3}, {to, from, 0.4}}, true), pushed) < 1e-12);
    CHECK(difference(moved({{from, to, 0.7}}, false), pushed) < 1e-12);
    CHECK(moved({{from, to, 0.35, 0.5}}, true) == pushed);
    // Between pins, or of no strength, there is nothing to do.
    CHECK(moved({{{0}, {n - 1}, 5.0}, {{3}, {4}, 0.0}}, true) == plain);
    // The residual of L - t / g d^T d.
    ComplexVector force = ComplexVector::Zero(n);
    force[3] = 1;
    force[20] = force[40] = -0.5;
    const double compliance = distance(inverse(force)).real();
    ComplexVector gradient;
    energy.apply(pushed, gradient);
    gradient -= 0.7 / 1.7 / compliance * distance(pushed) * force;
    for (const auto& pin : pins) gradient[pin.first] = 0;
    CHECK(gradient.norm() < 1e-12 * energy.max_diagonal() * pushed.norm());
  }
}

}  // namespace spectral_conformal::test
