#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "meshes.h"
#include "relaxation/distortion_sum.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::test {
namespace {

/// s1 = 2 s2 everywhere: c = 1.25, and sqrt(c^2 - 1) = 0.75.
ComplexVector stretched(const Patch& patch) {
  const ComplexVector flat = flat_map(patch.positions);
  return Complex(0, 7) * (flat + flat.real().cast<Complex>());
}

double value(DistortionSum& distortion, const ComplexVector& z) {
  ComplexVector gradient;
  return distortion.value_and_gradient(z, gradient);
}

DistortionSum sum_of(const Patch& patch, DistortionMeasure measure) {
  return DistortionSum::of(patch.elements(), measure, patch.positions.rows());
}

constexpr DistortionMeasure every_measure[] = {
    DistortionMeasure::symmetric_dirichlet, DistortionMeasure::conformal, {0.3}, {0, 0.25}};

/// A map with distortion of every kind, no triangle flipped.
ComplexVector uneven(const Patch& patch) {
  const ComplexVector flat = flat_map(patch.positions);
  return flat + 0.3 * flat.real().cast<Complex>() + 0.01 * random_map(flat.size());
}

/// Large enough for several parts.
Mesh many_triangles() { return bumpy_grid(260, 240); }

}  // namespace

TEST_SUITE_BEGIN("distortion_sum");

TEST_CASE("it is QC but for its smoothing, at any scale") {
  const Patch patch(quad_grid(5, 4));
  const ComplexVector z = stretched(patch);
  DistortionSum sum = sum_of(patch, {0, 0});
  CHECK(sum.anisotropy(z) == doctest::Approx(0.75));
  CHECK(value(sum, z) == doctest::Approx(2));
  sum.set_measure({0, 2.25});
  CHECK(value(sum, z) == doctest::Approx(1.25 + std::sqrt(1.25 * 1.25 - 1 + 2.25)));
  CHECK(value(sum, flat_map(patch.positions)) == doctest::Approx(1 + 1.5));
}

TEST_CASE("it is the mean that is reported, in one part and in several") {
  for (const Mesh& mesh : {bumpy_grid(12, 9), many_triangles()}) {
    const Patch patch(mesh);
    const ComplexVector z = uneven(patch);
    DistortionSum sum = sum_of(patch, {0, 0});
    const Distortion reported =
        measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, z);
    REQUIRE(reported.n_flipped() == 0);
    CHECK(value(sum, z) == doctest::Approx(reported.mean_qc).epsilon(1e-12));
  }
}

TEST_CASE("the gradient is that of finite differences") {
  const Patch patch(bumpy_grid(6, 5));
  const ComplexVector z = uneven(patch);
  for (const DistortionMeasure measure : every_measure) {
    for (const double regularization : {0.0, 0.3, std::numeric_limits<double>::infinity()}) {
      if (measure.is_quasi_conformal() && regularization == 0.3) continue;
      auto elements = patch.elements();
      elements[3].regularization = regularization;
      DistortionSum sum = DistortionSum::of(elements, measure, z.size());
      ComplexVector gradient;
      sum.value_and_gradient(z, gradient);
      for (const Eigen::Index v : {0, 6, 13}) {
        for (const Complex direction : {Complex(1, 0), Complex(0, 1)}) {
          constexpr double h = 1e-6;
          ComplexVector forward = z;
          ComplexVector backward = z;
          forward[v] += h * direction;
          backward[v] -= h * direction;
          const double slope = (value(sum, forward) - value(sum, backward)) / (2 * h);
          CHECK(slope == doctest::Approx(std::real(std::conj(direction) * gradient[v])).epsilon(1e-6));
        }
      }
    }
  }
}

TEST_CASE("the curvature is positive, and no less than that along a line") {
  const Patch patch(bumpy_grid(6, 5));
  const ComplexVector z = uneven(patch);
  DistortionSum distortion = sum_of(patch, {0, 0.25});
  const ComplexVector direction = 1e-2 * random_map(z.size());
  constexpr double h = 1e-2;
  const double along =
      (value(distortion, z + h * direction) + value(distortion, z - h * direction) - 2 * value(distortion, z)) /
      (h * h);
  CHECK(distortion.curvature(z, direction) > 0.3 * along);
  CHECK(distortion.curvature(z, direction) > 0);
}

TEST_CASE("a flipped triangle costs infinity, unless it has no weight or is regularized") {
  const Patch patch(Mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
  ComplexVector folded = flat_map(patch.positions);
  folded[1] = Complex(0, 0.9);
  auto elements = patch.elements();
  DistortionSum sum = DistortionSum::of(elements, {0, 0}, 4);
  CHECK(std::isinf(value(sum, folded)));
  sum.set_measure(DistortionMeasure::symmetric_dirichlet);
  CHECK(std::isinf(value(sum, folded)));
  elements[0].regularization = 0.1;
  sum.regularize(elements);
  CHECK(std::isfinite(value(sum, folded)));
  elements[0] = patch.elements()[0];
  elements[0].weight = 0;
  // The other half of the area.
  CHECK(value(sum = DistortionSum::of(elements, {0, 0}, 4), folded) == doctest::Approx(0.5));
}

TEST_CASE("the largest step ends where the first triangle loses its area, or at the limit") {
  const Patch patch(Mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
  const ComplexVector z = flat_map(patch.positions);
  DistortionSum distortion = sum_of(patch, {0, 0.25});
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
  DistortionSum distortion = sum_of(patch, {0, 0.25});
  for (const double size : {1e-3, 1e-1, 1.0, 10.0}) {
    const ComplexVector direction = size * random_map(z.size());
    double first = 1;
    for (const DistortionElement& element : elements) {
      first = std::min(first, DistortionSum::of(std::vector{element}, {}, z.size()).max_step(z, direction, 1));
    }
    CHECK(distortion.max_step(z, direction, 1) == first);
  }
}

TEST_CASE("no bit depends on the number of threads") {
  const Patch patch(many_triangles());
  const ComplexVector z = uneven(patch);
  const ComplexVector direction = random_map(z.size());
  const auto numbers = [&](unsigned threads, ComplexVector& gradient) {
    const ThreadLimit limit(threads);
    DistortionSum distortion = sum_of(patch, {0, 0.25});
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
