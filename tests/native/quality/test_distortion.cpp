#include <doctest/doctest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "geometry/quad_splits.h"
#include "geometry/triangle_shape.h"
#include "meshes.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

Distortion measure(const Patch& patch, const ComplexVector& z) {
  return measure_distortion(patch.positions, patch.chart.triangles, patch.chart.triangle_weights, z);
}

/// A map with moderate distortion and no flips.
ComplexVector bent(const Positions& positions) {
  ComplexVector z = flat_map(positions);
  for (Complex& p : z) p = Complex(p.real() + 0.1 * std::sin(p.imag()), 1.3 * p.imag() + 0.02 * p.real() * p.real());
  return z;
}

/// numpy.percentile, from all sorted values.
double percentile(Eigen::VectorXd values, double fraction) {
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<Eigen::Index>(std::floor(place));
  const Eigen::Index above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
}

}  // namespace

TEST_SUITE_BEGIN("distortion");

TEST_CASE("qc and scale per triangle are those of the Jacobian's singular values") {
  const Patch patch(perforated_grid(7, 7));
  const ComplexVector z = bent(patch.positions);
  const Distortion distortion = measure(patch, z);
  for (std::size_t t = 0; t < patch.chart.triangles.size(); ++t) {
    const auto& [a, b, c] = patch.chart.triangles[t];
    Eigen::Matrix<double, 3, 2> edges;
    edges << (patch.positions.row(b) - patch.positions.row(a)).transpose(),
        (patch.positions.row(c) - patch.positions.row(a)).transpose();
    Eigen::Matrix2d images;
    images << (z[b] - z[a]).real(), (z[c] - z[a]).real(), (z[b] - z[a]).imag(), (z[c] - z[a]).imag();
    // The image of the surface's own metric: the singular values of D E^+.
    const Eigen::MatrixXd jacobian = images * (edges.transpose() * edges).inverse() * edges.transpose();
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian).singularValues();
    const auto index = static_cast<Eigen::Index>(t);
    CHECK(distortion.qc[index] == doctest::Approx(values[0] / values[1]).epsilon(1e-11));
    CHECK(distortion.log2_scale[index] == doctest::Approx(0.5 * std::log2(values[0] * values[1])).epsilon(1e-11));
    CHECK_FALSE(distortion.flipped[t]);
  }
}

TEST_CASE("means are weighted by area, percentiles interpolate, and of a quad one split counts") {
  Mesh mesh = bumpy_grid(5, 4);
  mesh.add({29, 23, 30, 31});
  mesh.points.emplace_back(7, 3, 1);
  mesh.points.emplace_back(7, 4.5, 0);
  const Patch patch(mesh);
  const ComplexVector z = bent(patch.positions);
  const Distortion distortion = measure(patch, z);
  REQUIRE(distortion.qc.size() == 44);
  CHECK(distortion.triangulation == mapped_triangulation(patch.chart.triangles, patch.chart.triangle_weights, z));
  const auto n = static_cast<Eigen::Index>(distortion.triangulation.size());
  REQUIRE(n == 42);
  Eigen::VectorXd weight(n), qc(n), log2_scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int t = distortion.triangulation[static_cast<std::size_t>(i)];
    const auto& [a, b, c] = patch.chart.triangles[static_cast<std::size_t>(t)];
    weight[i] = triangle_area(patch.positions.row(a), patch.positions.row(b), patch.positions.row(c));
    CHECK(distortion.area[t] == doctest::Approx(weight[i]).epsilon(1e-13));
    CHECK(distortion.image_area[t] == doctest::Approx(weight[i] * std::exp2(2 * distortion.log2_scale[t])));
    qc[i] = distortion.qc[t];
    log2_scale[i] = distortion.log2_scale[t];
  }
  weight /= weight.sum();
  REQUIRE(weight.minCoeff() < 0.5 * weight.maxCoeff());
  CHECK(distortion.mean_qc == doctest::Approx(weight.dot(qc)).epsilon(1e-12));
  CHECK(distortion.max_qc == qc.maxCoeff());
  CHECK(distortion.qc_percentile(0.95) == doctest::Approx(percentile(qc, 0.95)).epsilon(1e-13));
  CHECK(distortion.qc_percentile(0.99) == doctest::Approx(percentile(qc, 0.99)).epsilon(1e-13));
  const Eigen::ArrayXd centered = log2_scale.array() - weight.dot(log2_scale);
  CHECK(distortion.log2_scale_deviation == doctest::Approx(std::sqrt(weight.dot(centered.square().matrix()))));
}

TEST_CASE("the mean alone is that of the whole measure, quads and degenerate triangles included") {
  for (const Mesh& mesh : {bumpy_grid(9, 7), quad_grid(6, 5), rounded_grid(8, 0.1)}) {
    const Patch patch(mesh);
    const auto& triangles = patch.chart.triangles;
    const auto& weights = patch.chart.triangle_weights;
    const ComplexVector flat = flat_map(patch.positions);
    const ComplexVector z = flat + 0.02 * random_map(flat.size());
    std::vector<TriangleShape> shapes;
    for (const auto& [a, b, c] : triangles) {
      shapes.push_back(local_isometric_frame(patch.positions.row(a), patch.positions.row(b), patch.positions.row(c)));
    }
    const double whole = measure_distortion(shapes, triangles, weights, z).mean_qc;
    const double alone = mean_quasi_conformal_distortion(shapes, triangles, weights, triangles.size(), z);
    CHECK((std::isinf(whole) ? std::isinf(alone) : alone == doctest::Approx(whole).epsilon(1e-12)));
    CHECK(mean_quasi_conformal_distortion(shapes, triangles, weights, 0, z) == 1);
  }
}

TEST_CASE("flipped means against the majority by area, so a mirror image has no flips") {
  const Patch patch(flat_grid(5, 5));
  ComplexVector z = flat_map(patch.positions);
  const auto flips = [&](const ComplexVector& map) {
    const auto flipped = measure(patch, map).flipped;
    return std::count(flipped.begin(), flipped.end(), true);
  };
  CHECK(flips(z) == 0);
  CHECK(flips(z.conjugate()) == 0);
  z[patch.chart.triangles[20][0]] += Complex(0.7, 1.6);
  const auto folded = flips(z);
  CHECK((folded > 0 && folded < 8));
  CHECK(flips(z.conjugate()) == folded);
}

TEST_CASE("an image without area is infinitely distorted; a degenerate triangle is not counted") {
  Mesh mesh = flat_grid(3, 3);
  mesh.points[6] = mesh.points[5];
  const Patch patch(mesh);
  ComplexVector z = flat_map(patch.positions);
  Distortion distortion = measure(patch, z);
  CHECK(distortion.max_qc == doctest::Approx(1).epsilon(1e-9));
  CHECK(distortion.log2_scale.allFinite());
  z[0] = z[1] = z[4] = z[5] = 0;
  distortion = measure(patch, z);
  CHECK(std::isinf(distortion.qc[0]));
  CHECK(std::isinf(distortion.max_qc));
  CHECK(std::isinf(distortion.mean_qc));
  CHECK(std::isinf(distortion.log2_scale_deviation));
  CHECK(distortion.log2_scale[0] == -std::numeric_limits<double>::infinity());
  CHECK_FALSE(distortion.flipped[0]);
}

TEST_CASE("no triangles: no distortion") {
  const Distortion distortion = measure_distortion(Positions(0, 3), {}, {}, {});
  CHECK(distortion.mean_qc == 1);
  CHECK(distortion.qc.size() == 0);
}

TEST_CASE("a mesh with mixed winding is oriented first, and flips are looked for chart by chart") {
  Mesh mesh = flat_grid(5, 5);
  Mesh second = flat_grid(3, 3);
  for (auto& p : second.points) p.x() += 20;
  mesh.append(second);
  const int n_first = 50;
  ComplexVector z(static_cast<Eigen::Index>(mesh.points.size()));
  for (Eigen::Index v = 0; v < z.size(); ++v) z[v] = Complex(mesh.points[v].x(), mesh.points[v].y());
  z.tail(16) = z.tail(16).conjugate().eval();  // the second chart as a whole: no flip
  for (const int face : {3, 4, 17, 40}) mesh.reverse(face);
  Distortion distortion = measure_mesh_distortion(mesh.view(), z);
  CHECK(std::count(distortion.flipped.begin(), distortion.flipped.end(), true) == 0);
  CHECK(std::count(distortion.overlapping.begin(), distortion.overlapping.end(), true) == 0);
  CHECK(distortion.turning_number == 1);
  CHECK(distortion.max_qc == doctest::Approx(1).epsilon(1e-9));
  z[14] += Complex(0.7, 1.6);
  distortion = measure_mesh_distortion(mesh.view(), z);
  const auto& flipped = distortion.flipped;
  CHECK(std::count(flipped.begin(), flipped.begin() + n_first, true) > 0);
  CHECK(std::count(flipped.begin() + n_first, flipped.end(), true) == 0);
  CHECK(std::count(distortion.overlapping.begin(), distortion.overlapping.end(), true) > 2);
}

TEST_CASE("the turning number is that of the largest chart") {
  Mesh mesh = flat_grid(2, 2);
  Mesh second = flat_grid(5, 5);
  for (auto& p : second.points) p.x() += 20;
  mesh.append(second);
  ComplexVector z(static_cast<Eigen::Index>(mesh.points.size()));
  for (Eigen::Index v = 0; v < z.size(); ++v) z[v] = Complex(mesh.points[v].x(), mesh.points[v].y());
  CHECK(measure_mesh_distortion(mesh.view(), z).turning_number == 1);
  z.tail(36) = z.tail(36).conjugate().eval();
  CHECK(measure_mesh_distortion(mesh.view(), z).turning_number == -1);
}

TEST_CASE("what is no triangle mesh is refused") {
  const Mesh quads = quad_grid(1, 1);
  CHECK_THROWS_AS(measure_mesh_distortion(quads.view(), ComplexVector::Zero(4)), InvalidMesh);
  Mesh broken = flat_grid(1, 1);
  broken.corners[0] = 99;
  CHECK_THROWS_AS(measure_mesh_distortion(broken.view(), ComplexVector::Zero(4)), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
