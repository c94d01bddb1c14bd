#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "meshes.h"
#include "relaxation/distortion_energy.h"
#include "relaxation/mean_distortion.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::test {
namespace {

/// s1 = 2 s2 everywhere: c = 1.25, and sqrt(c^2 - 1) = 0.75.
ComplexVector stretched(const Patch& patch) {
  const ComplexVector flat = flat_map(patch.positions);
  return Complex(0, 7) * (flat + flat.real().cast<Complex>());
}

double value(MeanDistortion& distortion, const ComplexVector& z) {
  ComplexVector gradient;
  return distortion.value_and_gradient(z, gradient);
}

/// A map with distortion of every kind, no triangle flipped.
ComplexVector uneven(const Patch& patch) {
  const ComplexVector flat = flat_map(patch.positions);
  return flat + 0.3 * flat.real().cast<Complex>() + 0.01 * random_map(flat.size());
}

/// Large enough for several parts.
Mesh many_triangles() { return bumpy_grid(260, 240); }

}  // namespace

TEST_SUITE_BEGIN("mean_distortion");

TEST_CASE("it is QC but for its smoothing, at any scale") {
  const Patch patch(quad_grid(5, 4));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const ComplexVector z = stretched(patch);
  MeanDistortion sharp = MeanDistortion::of(energy, z, 1e-9);
  CHECK(sharp.anisotropy() == doctest::Approx(0.75));
  CHECK(value(sharp, z) == doctest::Approx(2));
  MeanDistortion smoothed = MeanDistortion::of(energy, z, 2);
  CHECK(value(smoothed, z) == doctest::Approx(1.25 + std::sqrt(1.25 * 1.25 - 1 + 2.25)));
  CHECK(value(smoothed, flat_map(patch.positions)) == doctest::Approx(1 + 1.5));
}

TEST_CASE("it is the mean that is reported, in one part and in several") {
  for (const Mesh& mesh : {bumpy_grid(12, 9), many_triangles()}) {
    const Patch patch(mesh);
    const ComplexVector z = uneven(patch);
    MeanDistortion distortion = MeanDistortion::of(patch.energy(Weights::uniform), z, 1e-9);
    const Distortion reported =
        measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, z);
    REQUIRE(reported.n_flipped() == 0);
    CHECK(value(distortion, z) == doctest::Approx(reported.mean_qc).epsilon(1e-12));
  }
}

TEST_CASE("the gradient is that of finite differences") {
  const Patch patch(bumpy_grid(6, 5));
  const ComplexVector z = uneven(patch);
  MeanDistortion distortion = MeanDistortion::of(patch.energy(Weights::uniform), z, 1);
  ComplexVector gradient;
  distortion.value_and_gradient(z, gradient);
  for (const Eigen::Index v : {0, 6, 13}) {
    for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
      constexpr double h = 1e-6;
      ComplexVector forward = z;
      ComplexVector backward = z;
      forward[v] += h * direction;
      backward[v] -= h * direction;
      const double slope = (value(distortion, forward) - value(distortion, backward)) / (2 * h);
      CHECK(slope == doctest::Approx(std::real(std::conj(direction) * gradient[v])).epsilon(1e-6));
    }
  }
}

TEST_CASE("the curvature is positive, and no less than that along a line") {
  const Patch patch(bumpy_grid(6, 5));
  const ComplexVector z = uneven(patch);
  MeanDistortion distortion = MeanDistortion::of(patch.energy(Weights::uniform), z, 1);
  const ComplexVector direction = 1e-2 * random_map(z.size());
  constexpr double h = 1e-2;
  const double along =
      (value(distortion, z + h * direction) + value(distortion, z - h * direction) - 2 * value(distortion, z)) /
      (h * h);
  CHECK(distortion.curvature(z, direction) > 0.3 * along);
  CHECK(distortion.curvature(z, direction) > 0);
}

TEST_CASE("a flipped triangle costs infinity, unless it was flipped in the first map") {
  const Patch patch(Mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const ComplexVector flat = flat_map(patch.positions);
  ComplexVector folded = flat;
  folded[1] = Complex(0, 0.9);
  MeanDistortion from_flat = MeanDistortion::of(energy, flat, 1);
  CHECK(std::isinf(value(from_flat, folded)));
  MeanDistortion from_folded = MeanDistortion::of(energy, folded, 1);
  // The other half of the area.
  CHECK(value(from_folded, folded) == doctest::Approx(0.5));
}

TEST_CASE("the largest step ends where the first triangle loses its area, or at the limit") {
  const Patch patch(Mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
  const ComplexVector z = flat_map(patch.positions);
  MeanDistortion distortion = MeanDistortion::of(patch.energy(Weights::uniform), z, 1);
  ComplexVector direction = ComplexVector::Zero(4);
  direction[1] = Complex(-1, 1);  // reaches the diagonal half way
  CHECK(distortion.max_step(z, direction, 10) == doctest::Approx(0.5));
  CHECK(distortion.max_step(z, direction, 0.4) == 0.4);
  CHECK(distortion.max_step(z, Complex(1, 0) * z, 10) == 10);
  // All triangles vanish at 1 and are as they were at 2.
  CHECK(distortion.max_step(z, -z, 2) == doctest::Approx(1));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(distortion.max_step(z, direction, infinity) == doctest::Approx(0.5));
  CHECK(std::isinf(distortion.max_step(z, z, infinity)));
}

TEST_CASE("the largest step is that of all triangles, one by one") {
  const Patch patch(bumpy_grid(20, 15));
  const auto elements = patch.elements();
  const ComplexVector z = uneven(patch);
  MeanDistortion distortion = MeanDistortion::of(patch.energy(Weights::uniform), z, 1);
  for (const double size : {1e-3, 1e-1, 1.0, 10.0}) {
    const ComplexVector direction = size * random_map(z.size());
    const double largest = max_step(elements, z, direction);
    CHECK(distortion.max_step(z, direction, 1.0) == doctest::Approx(std::min(1.0, largest)).epsilon(1e-12));
  }
}

TEST_CASE("no bit depends on the number of threads") {
  const Patch patch(many_triangles());
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  const ComplexVector z = uneven(patch);
  const ComplexVector direction = random_map(z.size());
  const auto numbers = [&](unsigned threads, ComplexVector& gradient) {
    const ThreadLimit limit(threads);
    MeanDistortion distortion = MeanDistortion::of(energy, z, 1);
    const double mean = distortion.value_and_gradient(z, gradient);
    return std::array<double, 3>{mean, distortion.curvature(z, direction), distortion.max_step(z, direction, 1)};
  };
  ComplexVector of_one;
  ComplexVector of_many;
  CHECK(numbers(1, of_one) == numbers(3, of_many));
  CHECK(of_one == of_many);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
