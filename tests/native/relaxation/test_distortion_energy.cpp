#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "meshes.h"
#include "relaxation/distortion_energy.h"

namespace spectral_conformal::test {
namespace {

constexpr DistortionMeasure measures[] = {DistortionMeasure::symmetric_dirichlet, DistortionMeasure::conformal,
                                          DistortionMeasure{0.3}};

/// The flat map, moved a little.
ComplexVector moved(const Patch& patch) {
  const ComplexVector flat = flat_map(patch.positions);
  return flat + 0.1 * random_map(flat.size());
}

}  // namespace

TEST_SUITE_BEGIN("distortion_energy");

TEST_CASE("weights are shares of the area; an isometry has 4 or 2, a similarity keeps the conformal one") {
  const Patch patch(quad_grid(5, 4));
  const auto elements = patch.elements();
  double total = 0;
  for (const DistortionElement& element : elements) total += element.weight;
  CHECK(total == doctest::Approx(1));
  const ComplexVector flat = flat_map(patch.positions);
  CHECK(energy_of(elements, DistortionMeasure::symmetric_dirichlet, flat) == doctest::Approx(4));
  CHECK(energy_of(elements, DistortionMeasure::conformal, Complex(3, -4) * flat) == doctest::Approx(2));
  // s1 = 2, s2 = 1
  const ComplexVector stretched = flat + flat.real().cast<Complex>();
  CHECK(energy_of(elements, DistortionMeasure::symmetric_dirichlet, stretched) == doctest::Approx(4 + 1 + 0.25 + 1));
  CHECK(energy_of(elements, DistortionMeasure::conformal, stretched) == doctest::Approx(2.5));
}

TEST_CASE("the measure is linear in the share of sizes, least where both parts are") {
  const Patch patch(bumpy_grid(4, 3));
  const auto elements = patch.elements();
  const ComplexVector z = moved(patch);
  const double angles = energy_of(elements, DistortionMeasure::conformal, z);
  const double sizes = energy_of(elements, DistortionMeasure::symmetric_dirichlet, z);
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const DistortionMeasure measure{share};
    CHECK(energy_of(elements, measure, z) == doctest::Approx((1 - share) * angles + share * sizes));
    const Patch flat(flat_grid(4, 3));
    CHECK(energy_of(flat.elements(), measure, flat_map(flat.positions)) == doctest::Approx(measure.infimum()));
  }
}

TEST_CASE("a flipped triangle costs infinity behind a barrier and a finite amount without") {
  const Patch patch(flat_grid(3, 3));
  auto elements = patch.elements();
  const ComplexVector mirrored = flat_map(patch.positions).conjugate();
  CHECK(count_flipped(elements, mirrored) == static_cast<int>(elements.size()));
  for (const DistortionMeasure measure : measures) {
    CHECK(std::isinf(energy_of(elements, measure, mirrored)));
    auto soft = elements;
    for (DistortionElement& element : soft) element.regularization = 0.1;
    CHECK(energy_of(soft, measure, mirrored) > 100);
    CHECK(std::isfinite(energy_of(soft, measure, mirrored)));
  }
}

TEST_CASE("degenerate triangles only hold their vertices together, virtual ones count a hundredth") {
  Mesh mesh = bumpy_grid(3, 3);
  mesh.points.emplace_back(0.5 * (mesh.points[1] + mesh.points[2]));
  mesh.add({2, 1, static_cast<int>(mesh.points.size()) - 1});
  const Patch patch(mesh);
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const auto elements = distortion_elements(energy.triangles(), energy.shapes(), energy.triangle_weights(), 0);
  CHECK_FALSE(elements.back().measured);
  CHECK(std::isinf(elements.back().regularization));
  CHECK(count_flipped(elements, flat_map(patch.positions)) == 0);
  const auto with_virtual = distortion_elements(energy.triangles(), energy.shapes(), energy.triangle_weights(), 2);
  const std::size_t first_virtual = elements.size() - 2;
  CHECK(with_virtual[first_virtual].weight == doctest::Approx(0.01 * elements[first_virtual].weight));
  CHECK_FALSE(with_virtual[first_virtual].measured);
}

TEST_CASE("the mean scale factor undoes a scale, and is 0 where nothing has image area") {
  const Patch patch(flat_grid(4, 3));
  const auto elements = patch.elements();
  const ComplexVector z = flat_map(patch.positions);
  CHECK(mean_scale_factor(elements, 8 * z) == doctest::Approx(0.125));
  CHECK(mean_scale_factor(elements, ComplexVector(z.conjugate())) == 0);
  // Slivers count if there is nothing else.
  const ComplexVector thin = (1e4 * z.real().cast<Complex>() + Complex(0, 1) * z.imag().cast<Complex>()).eval();
  CHECK(mean_scale_factor(elements, thin) == doctest::Approx(0.01));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
