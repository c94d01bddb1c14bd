#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "relaxation/descent.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
TEST_SUITE_BEGIN("descent");

TEST_CASE("the conformal descent of a flat patch ends at a similarity, whatever the backend") {
  const Patch patch(flat_grid(8, 6));
  const ComplexVector flat = flat_map(patch.positions);
  for (const auto backend : backends()) {
    auto elements = patch.elements();
    ComplexVector z = flat + 0.15 * random_map(flat.size());
    const Descent descent = descend(elements, {}, z, backend, {DistortionMeasure::conformal, 1e-6, 60}, {});
    CHECK(descent.iterations > 0);
    CHECK(energy_of(elements, DistortionMeasure::conformal, z) == doctest::Approx(2).epsilon(1e-6));
    CHECK(difference_up_to_similarity(z, flat) < 1e-2);
  }
}

TEST_CASE("both measures fall, and no triangle flips") {
  const Patch patch(bumpy_grid(10, 8));
  const ComplexVector start = flat_map(patch.positions) + 0.1 * random_map(patch.positions.rows());
  for (const auto measure : {DistortionMeasure::symmetric_dirichlet, DistortionMeasure::conformal}) {
    auto elements = patch.elements();
    REQUIRE(count_flipped(elements, start) == 0);
    ComplexVector z = start;
    descend(elements, {}, z, FactorizationBackend::automatic, {measure, 1e-4, 40}, {});
    CHECK(energy_of(elements, measure, z) < energy_of(elements, measure, start));
    CHECK(count_flipped(elements, z) == 0);
  }
}

TEST_CASE("the least conformal distortion is below that of the spectral map") {
  const Patch patch(bumpy_grid(10, 8));
  auto elements = patch.elements();
  ComplexVector z = Solver::of(patch.chart, patch.positions, PatchOptions{}).solve({}, {}).z;
  const double before = energy_of(elements, DistortionMeasure::conformal, z);
  descend(elements, {}, z, FactorizationBackend::automatic, {DistortionMeasure::conformal, 1e-6, 40}, {});
  const double after = energy_of(elements, DistortionMeasure::conformal, z);
  CHECK(after < before);
  CHECK(after - 2 > 0.5 * (before - 2));
}

TEST_CASE("fixed vertices stay exactly, the others move") {
  const Patch patch(bumpy_grid(8, 6));
  auto elements = patch.elements();
  const ComplexVector start = flat_map(patch.positions) + 0.1 * random_map(patch.positions.rows());
  std::vector<char> fixed(static_cast<std::size_t>(start.size()), 0);
  for (const int v : patch.outer()) fixed[v] = 1;
  ComplexVector z = start;
  descend(elements, fixed, z, FactorizationBackend::automatic, {DistortionMeasure::conformal, 1e-4, 20}, {});
  int moved = 0;
  for (Eigen::Index v = 0; v < z.size(); ++v) {
    if (fixed[static_cast<std::size_t>(v)]) CHECK(z[v] == start[v]);
    if (!fixed[static_cast<std::size_t>(v)] && z[v] != start[v]) ++moved;
  }
  CHECK(moved > 0);
}

TEST_CASE("a flipped triangle is pulled in and then keeps its area") {
  const Patch patch(flat_grid(6, 6));
  for (const auto measure : {DistortionMeasure::symmetric_dirichlet, DistortionMeasure::conformal}) {
    auto elements = patch.elements();
    ComplexVector z = flat_map(patch.positions);
    z[24] += Complex(1.6, 0.4);  // an inner vertex, beyond its neighbors
    REQUIRE(count_flipped(elements, z) > 0);
    descend(elements, {}, z, FactorizationBackend::automatic, {measure, 1e-3, 40}, {});
    CHECK(count_flipped(elements, z) == 0);
  }
}

TEST_CASE("a rejected round takes its barriers back: the energy of what is returned is finite") {
  // One flipped triangle is held. Later rounds find room for flipped ones that are not measured, which does not count:
  // they are rejected. Barriers that stayed would be infinite on these triangles, and any step would be accepted.
  const Patch patch(bumpy_grid(10, 8));
  for (const double crease : {1.5, 2.5, 5.5, 6.5}) {
    ComplexVector z = flat_map(patch.positions);
    for (Complex& value : z) {
      if (value.real() > crease) value.real(2 * crease - value.real());
    }
    auto elements = patch.elements();
    std::size_t last = 0;
    for (std::size_t t = 0; t < elements.size(); ++t) {
      elements[t].measured = t % 2 == 0;
      if (elements[t].measured && !(jacobian(elements[t], z).determinant > 0)) last = t;
    }
    std::vector<char> held(static_cast<std::size_t>(z.size()), 0);
    for (const int v : elements[last].corners) held[v] = 1;
    const int flipped = count_flipped(elements, z);
    const Descent descent = descend(elements, held, z, FactorizationBackend::automatic, {});
    CHECK(count_flipped(elements, z) >= 1);
    CHECK(count_flipped(elements, z) < flipped);
    const double energy = energy_of(elements, DistortionMeasure::symmetric_dirichlet, z);
    CHECK(std::isfinite(energy));
    CHECK(descent.energy == energy);
  }
}

TEST_CASE("the status tells convergence from a bound that came first, the energies what was gained") {
  const Patch patch(bumpy_grid(10, 8));
  const ComplexVector start = flat_map(patch.positions) + 0.1 * random_map(patch.positions.rows());
  for (const auto measure : {DistortionMeasure::symmetric_dirichlet, DistortionMeasure::conformal}) {
    const auto run = [&](double tolerance, int max_factorizations, ComplexVector& z) {
      auto elements = patch.elements();
      const Descent descent =
          descend(elements, {}, z, FactorizationBackend::automatic, {measure, tolerance, max_factorizations});
      CHECK(descent.energy_before == energy_of(elements, measure, start));
      CHECK(descent.energy == energy_of(elements, measure, z));
      CHECK(descent.energy < descent.energy_before);
      CHECK(descent.iterations > 0);
      return descent;
    };
    ComplexVector z = start;
    const Descent bounded = run(0, 1, z);
    CHECK(bounded.status == RelaxationStatus::factorization_limit);
    CHECK(bounded.factorizations == 1);
    z = start;
    const Descent converged = run(1e-3, 60, z);
    CHECK(converged.status == RelaxationStatus::converged);
    CHECK(converged.factorizations < 60);
    CHECK(converged.energy < bounded.energy);
    // From its end the descent has no way to go.
    auto elements = patch.elements();
    const ComplexVector end = z;
    const Descent again = descend(elements, {}, z, FactorizationBackend::automatic, {measure, 1e-2, 60});
    CHECK(again.status == RelaxationStatus::converged);
    CHECK(again.energy > 0.99 * converged.energy);
    CHECK(again.factorizations <= 2);
  }
}

TEST_CASE("a descent that barriers stop although its gradient promises more has stalled") {
  // Folded over near its end, where the flipped majority leaves no room: steps are cut to nothing.
  const Patch patch(bumpy_grid(10, 8));
  for (const double crease : {0.5, 1.5}) {
    ComplexVector z = flat_map(patch.positions);
    for (Complex& value : z) {
      if (value.real() > crease) value.real(2 * crease - value.real());
    }
    auto elements = patch.elements();
    const Descent descent =
        descend(elements, {}, z, FactorizationBackend::automatic, {DistortionMeasure::conformal, 1e-2, 60});
    CHECK(count_flipped(elements, z) > 0);
    CHECK(descent.status == RelaxationStatus::stalled);
    CHECK(descent.factorizations < 60);
  }
}

TEST_CASE("step by step it goes the same way") {
  const Patch patch(bumpy_grid(10, 8));
  const ComplexVector start = flat_map(patch.positions) + 0.1 * random_map(patch.positions.rows());
  const DescentOptions options{DistortionMeasure{0.5}, 1e-6, 60};
  auto elements = patch.elements();
  ComplexVector z = start;
  const Descent whole = descend(elements, {}, z, FactorizationBackend::automatic, options);
  StepwiseDescent descent =
      StepwiseDescent::begin(patch.elements(), {}, start, FactorizationBackend::automatic, options);
  CHECK(descent.z() == start);
  int calls = 1;
  while (descent.advance()) ++calls;
  CHECK(calls >= whole.iterations);
  CHECK(descent.z() == z);
  CHECK(descent.result().energy == whole.energy);
  CHECK(descent.result().status == whole.status);
  CHECK_FALSE(descent.advance());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
