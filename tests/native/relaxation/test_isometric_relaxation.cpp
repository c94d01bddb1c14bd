#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "mesh/hole_filling.h"
#include "meshes.h"
#include "relaxation/descent.h"
#include "relaxation/isometric_relaxation.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

DescentOptions within(double tolerance, int max_factorizations) {
  return {DistortionMeasure::symmetric_dirichlet, tolerance, max_factorizations};
}

IsometricMap relax(const ConformalEnergy& energy, const ComplexVector& z, const DescentOptions& options = {},
                   FactorizationBackend backend = FactorizationBackend::automatic, const Progress& progress = {}) {
  return relax_to_isometry(energy.triangles(), energy.shapes(), energy.triangle_weights(), energy.n_virtual(), z,
                           backend, options, progress);
}

IsometricMap relax(const Patch& patch, const ComplexVector& z, const DescentOptions& options = {},
                   FactorizationBackend backend = FactorizationBackend::automatic, const Progress& progress = {}) {
  return relax(patch.energy(Weights::uniform), z, options, backend, progress);
}

Distortion distortion(const Patch& patch, const ComplexVector& z) {
  return measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, z);
}

/// The mean of s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 at the scale of z: squared norms of real matrices and their inverses.
double symmetric_dirichlet_energy(const Patch& patch, const ComplexVector& z) {
  const ConformalEnergy energy = patch.energy(Weights::uniform);
  double sum = 0;
  double area = 0;
  for (std::size_t t = 0; t < energy.triangles().size(); ++t) {
    const auto& [a, b, c] = energy.triangles()[t];
    const TriangleShape& shape = energy.shapes()[t];
    if (shape.clamped) continue;
    Eigen::Matrix2d edges;
    edges << shape.x1, shape.x2, 0, shape.y2;
    Eigen::Matrix2d image;
    image << (z[b] - z[a]).real(), (z[c] - z[a]).real(), (z[b] - z[a]).imag(), (z[c] - z[a]).imag();
    const Eigen::Matrix2d jacobian = image * edges.inverse();
    const double weight = energy.triangle_weights()[t] * shape.area();
    sum += weight * (jacobian.squaredNorm() + jacobian.inverse().squaredNorm());
    area += weight;
  }
  return sum / area;
}

/// A grid bent along its columns, hence developable, and the plane it came from.
Mesh bent_grid(int columns, int rows, ComplexVector& flat) {
  Mesh mesh = quad_grid(columns, rows);
  flat.resize(static_cast<Eigen::Index>(mesh.points.size()));
  const double turn = 0.25;
  const double radius = 0.5 / std::sin(0.5 * turn);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const int v = j * (columns + 1) + i;
      mesh.points[v] = {radius * std::sin(turn * i), static_cast<double>(j), radius * std::cos(turn * i)};
      flat[v] = Complex(i, j);
    }
  }
  return mesh;
}

/// A cylinder of radius 1 with a hemisphere on top, cut open at the bottom. In its conformal map the top is about
/// exp(length) times as small as the bottom.
Mesh finger(int rings, int segments, double length) {
  Mesh mesh;
  mesh.points.emplace_back(0, 0, 1);
  for (int k = 1; k <= rings; ++k) {
    const double t = (0.5 * pi + length) * k / rings;
    const bool round = t < 0.5 * pi;
    const double radius = round ? std::sin(t) : 1.0;
    const double height = round ? std::cos(t) : 0.5 * pi - t;
    for (int s = 0; s < segments; ++s) {
      const double angle = 2 * pi * (s + 0.5 * k) / segments;
      mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  for (int s = 0; s < segments; ++s) {
    const int next = (s + 1) % segments;
    mesh.add({0, 1 + s, 1 + next});
    for (int k = 1; k < rings; ++k) {
      const int inner = 1 + (k - 1) * segments;
      const int outer = inner + segments;
      mesh.add({inner + s, outer + s, inner + next});
      mesh.add({outer + s, outer + next, inner + next});
    }
  }
  return mesh;
}

/// Part of the unit sphere, from the stereographic projection of a square.
Mesh spherical_cap(int n) {
  Mesh mesh = flat_grid(n, n);
  for (Eigen::Vector3d& p : mesh.points) {
    const Complex z = Complex(p.x(), p.y()) / (0.5 * n) - Complex(1, 1);
    p = Eigen::Vector3d(2 * z.real(), 2 * z.imag(), 1 - std::norm(z)) / (1 + std::norm(z));
  }
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("isometric_relaxation");

TEST_CASE("the energy is that of real matrices at the best scale; it falls, without a flip, in both backends") {
  for (const Mesh& mesh : {bumpy_grid(14, 11), perforated_grid(12, 9)}) {
    const Patch patch(mesh);
    const ComplexVector start = conformal_map(patch);
    REQUIRE(count_flipped(patch, start) == 0);
    for (const auto backend : backends()) {
      const IsometricMap map = relax(patch, start, {}, backend);
      CHECK(map.energy == doctest::Approx(symmetric_dirichlet_energy(patch, map.z)).epsilon(1e-10));
      for (const double factor : {0.999, 1.001}) {
        CHECK(symmetric_dirichlet_energy(patch, factor * map.z) > map.energy);
        CHECK(symmetric_dirichlet_energy(patch, factor * start) >= map.energy_before);
      }
      CHECK(map.energy >= 4);
      CHECK(map.energy < map.energy_before);
      CHECK(map.flipped == 0);
      CHECK(count_flipped(patch, map.z) == 0);
      CHECK(distortion(patch, map.z).log2_scale_deviation < 0.5 * distortion(patch, start).log2_scale_deviation);
    }
  }
}

TEST_CASE("a developable patch comes back to its isometry from a conformal start") {
  ComplexVector flat;
  const Patch patch(bent_grid(12, 9, flat));
  // The scale of this start varies by a factor of 9.
  const ComplexVector start = ((0.15 * Complex(1, 0.7)) * flat).array().exp();
  const IsometricMap map = relax(patch, start, within(1e-6, 50));
  CHECK(map.energy_before > 5);
  CHECK(map.energy - 4 < 1e-6);
  CHECK(difference_up_to_similarity(map.z, flat) < 1e-3);
  CHECK(distortion(patch, map.z).log2_scale_deviation < 1e-3);
  const Complex edge = map.z[1] - map.z[0];
  CHECK(std::abs(edge) == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("the spread of scale at least halves on a spherical cap and on a finger, without flips") {
  for (const Mesh& mesh : {spherical_cap(20), finger(24, 16, 5), finger(60, 20, 8)}) {
    const Patch patch(mesh);
    const ComplexVector conformal = conformal_map(patch);
    const IsometricMap map = relax(patch, conformal);
    const Distortion before = distortion(patch, conformal);
    const Distortion after = distortion(patch, map.z);
    CHECK(after.log2_scale_deviation < 0.5 * before.log2_scale_deviation);
    CHECK(count_flipped(patch, map.z) == 0);
    CHECK(map.factorizations <= DescentOptions().max_factorizations);
  }
}

TEST_CASE("a similarity of the start is one of the result") {
  const Patch patch(bumpy_grid(10, 8));
  const ComplexVector start = conformal_map(patch);
  const IsometricMap map = relax(patch, start);
  for (const double scale : {1e-12, 1.0, 1e12}) {
    const ComplexVector moved = (scale * Complex(0.6, 0.8) * start).array() + scale * Complex(3, -5);
    const IsometricMap other = relax(patch, moved);
    CHECK(other.energy_before == doctest::Approx(map.energy_before).epsilon(1e-10));
    CHECK(other.energy == doctest::Approx(map.energy).epsilon(1e-6));
    // Not exactly: the rounding of the start decides where the steps are cut.
    CHECK(difference_up_to_similarity(other.z, map.z) < 1e-4);
  }
}

TEST_CASE("what cannot be unfolded stays: no further flips, finite") {
  const Patch patch(bumpy_grid(10, 8));
  const ComplexVector conformal = conformal_map(patch);
  ComplexVector folded = conformal;
  const double middle = conformal.real().mean();
  for (Eigen::Index v = 0; v < folded.size(); ++v) {
    if (folded[v].real() > middle + 0.2) folded[v].real(2 * (middle + 0.2) - folded[v].real());
  }
  const IsometricMap map = relax(patch, folded);
  CHECK(map.z.allFinite());
  CHECK(std::isfinite(map.energy));
  CHECK(map.flipped == count_flipped(patch, map.z));
  CHECK(map.flipped <= count_flipped(patch, folded));
}

TEST_CASE("a start without any image area is returned as it is") {
  const Patch patch(bumpy_grid(4, 3));
  const ComplexVector conformal = conformal_map(patch);
  const ComplexVector mirrored = conformal.conjugate();
  const ComplexVector line = conformal.real().cast<Complex>();
  const ComplexVector point = ComplexVector::Constant(conformal.size(), Complex(1, 2));
  for (const ComplexVector& start : {mirrored, line, point}) {
    const IsometricMap map = relax(patch, start);
    CHECK(map.z == start);
    CHECK(map.status == RelaxationStatus::no_image_area);
    CHECK(map.iterations == 0);
    CHECK(map.energy_before == 0);
    CHECK(map.flipped == static_cast<int>(patch.chart.triangles.size()));
  }
}

TEST_CASE("virtual triangles keep holes open and hardly change the map") {
  const Patch patch(perforated_grid(12, 9));
  int outer = 0;
  for (std::size_t k = 0; k < patch.chart.boundary_loops.size(); ++k) {
    if (patch.chart.boundary_loops[k] == patch.outer()) outer = static_cast<int>(k);
  }
  const HoleFilling filling = fill_holes(patch.chart.boundary_loops, outer, patch.positions);
  REQUIRE(filling.centers.rows() == 0);
  std::vector<std::array<int, 3>> triangles = patch.chart.triangles;
  std::vector<TriangleWeight> triangle_weights = patch.chart.triangle_weights;
  triangles.insert(triangles.end(), filling.triangles.begin(), filling.triangles.end());
  triangle_weights.insert(triangle_weights.end(), filling.triangle_weights.begin(), filling.triangle_weights.end());
  const ConformalEnergy filled =
      conformal_energy(patch.positions, triangles, triangle_weights, Weights::uniform, filling.triangles.size());
  const ComplexVector start = conformal_map(patch);
  const IsometricMap map = relax(filled, start, within(1e-6, 50));
  const IsometricMap without = relax(patch, start, within(1e-6, 50));
  CHECK(map.flipped == 0);
  CHECK(map.energy_before == doctest::Approx(without.energy_before).epsilon(1e-12));
  CHECK(map.energy == doctest::Approx(without.energy).epsilon(1e-3));
  CHECK(difference_up_to_similarity(map.z, without.z) < 0.01);
  for (const auto& [a, b, c] : filling.triangles) {
    CHECK(std::imag(std::conj(map.z[b] - map.z[a]) * (map.z[c] - map.z[a])) > 0);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
