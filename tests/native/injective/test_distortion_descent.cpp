#include <doctest/doctest.h>

#include "injective/distortion_descent.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

double energy_of(const std::vector<DistortionElement>& elements, DistortionMeasure measure, const ComplexVector& z) {
  ComplexVector gradient;
  return energy_and_gradient(elements, measure, z, gradient);
}

}  // namespace

TEST_SUITE_BEGIN("distortion_descent");

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
  ComplexVector z = Solver(patch.chart, patch.positions, PatchOptions{}).solve({}, {}).z;
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

TEST_CASE("a folded triangle is pulled in and then keeps its area") {
  const Patch patch(flat_grid(6, 6));
  for (const auto measure : {DistortionMeasure::symmetric_dirichlet, DistortionMeasure::conformal}) {
    auto elements = patch.elements();
    ComplexVector z = flat_map(patch.positions);
    z[24] += Complex(1.6, 0.4);  // an inner vertex, beyond its neighbours
    REQUIRE(count_flipped(elements, z) > 0);
    descend(elements, {}, z, FactorizationBackend::automatic, {measure, 1e-3, 40}, {});
    CHECK(count_flipped(elements, z) == 0);
  }
}

TEST_CASE("it can be cancelled") {
  const Patch patch(bumpy_grid(6, 6));
  auto elements = patch.elements();
  ComplexVector z = flat_map(patch.positions);
  CHECK_THROWS_AS(
      descend(elements, {}, z, FactorizationBackend::automatic, {}, [](double, const char*) { return false; }),
      Cancelled);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
