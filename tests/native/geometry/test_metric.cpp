#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "meshes.h"
#include "spectral_conformal/metric.h"

namespace spectral_conformal::test {
namespace {

const Eigen::Vector3d p0(1, 2, 3), p1(2.5, 1, 4), p2(0.5, 3, 6);

Eigen::Matrix2d matrix(const TriangleMetric& g) { return (Eigen::Matrix2d() << g.xx, g.xy, g.xy, g.yy).finished(); }

double length(const TriangleMetric& g, Complex t) {
  const Eigen::Vector2d vector(t.real(), t.imag());
  return std::sqrt(vector.dot(matrix(g) * vector));
}

const TriangleMetric skew{3, -1.2, 0.8};

}  // namespace

TEST_SUITE_BEGIN("metric");

TEST_CASE("the stretched triangle has the lengths of the metric") {
  const TriangleShape shape = local_isometric_frame(p0, p1, p2);
  const TriangleShape result = stretched(shape, skew);
  const Complex third(shape.x2, shape.y2);
  CHECK(result.x1 == doctest::Approx(length(skew, shape.x1)).epsilon(1e-14));
  CHECK(std::abs(Complex(result.x2, result.y2)) == doctest::Approx(length(skew, third)).epsilon(1e-14));
  CHECK(std::abs(Complex(result.x2 - result.x1, result.y2)) ==
        doctest::Approx(length(skew, third - shape.x1)).epsilon(1e-14));
  CHECK(result.y2 > 0);
}

TEST_CASE("stretched by the metric of a map, a triangle has the shape of its image") {
  const TriangleShape shape = local_isometric_frame(p0, p1, p2);
  const Complex d1(0.3, 2);
  const Complex d2(-4, 1);
  const TriangleShape result = stretched(shape, metric_of_map(shape, d1, d2));
  CHECK(result.x1 == doctest::Approx(std::abs(d1)).epsilon(1e-14));
  const Complex third = d2 / (d1 / std::abs(d1));
  CHECK(result.x2 == doctest::Approx(third.real()).epsilon(1e-13));
  CHECK(result.y2 == doctest::Approx(third.imag()).epsilon(1e-13));
}

TEST_CASE("a tensor of space is restricted to the plane, whichever corner comes first") {
  SpaceMetric tensor;
  tensor << 2, 0.3, -0.1, 0.3, 1, 0.2, -0.1, 0.2, 0.5;
  const auto check = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const TriangleShape result = stretched(local_isometric_frame(a, b, c), restrict_to_triangle(tensor, a, b, c));
    const auto measured = [&](const Eigen::Vector3d& t) { return std::sqrt(t.dot(tensor * t)); };
    CHECK(result.x1 == doctest::Approx(measured(b - a)).epsilon(1e-13));
    CHECK(std::hypot(result.x2, result.y2) == doctest::Approx(measured(c - a)).epsilon(1e-13));
    CHECK(std::hypot(result.x2 - result.x1, result.y2) == doctest::Approx(measured(c - b)).epsilon(1e-13));
  };
  check(p0, p1, p2);
  check(p1, p2, p0);
  check(p0, p2, p1);
  const TriangleMetric flat = restrict_to_triangle(tensor, p0, p0, p0);
  CHECK(matrix(flat) == Eigen::Matrix2d::Identity());
}

TEST_CASE("a direction and a ratio") {
  const auto frame = tangent_frame(p0, p1, p2);
  CHECK((frame * frame.transpose()).isIdentity(1e-14));
  const Eigen::Vector3d direction = 3 * frame.row(0).transpose() + 4 * frame.row(1).transpose();
  const TriangleMetric g = metric_along(direction, 2.5, frame);
  CHECK(length(g, Complex(0.6, 0.8)) == doctest::Approx(2.5).epsilon(1e-14));
  CHECK(length(g, Complex(-0.8, 0.6)) == doctest::Approx(1).epsilon(1e-14));
  const Eigen::Vector3d normal = frame.row(0).cross(frame.row(1));
  CHECK(matrix(metric_along(direction + 7 * normal, 2.5, frame)).isApprox(matrix(g), 1e-14));
  CHECK(matrix(metric_along(normal, 2.5, frame)) == Eigen::Matrix2d::Identity());
}

TEST_CASE("blending takes powers of the metric of determinant 1") {
  CHECK(matrix(blend(skew, 0)).isIdentity(1e-15));
  const Eigen::Matrix2d whole = matrix(blend(skew, 1));
  CHECK(whole.isApprox(matrix(skew) / std::sqrt(matrix(skew).determinant()), 1e-14));
  const Eigen::Matrix2d half = matrix(blend(skew, 0.5));
  CHECK((half * half).isApprox(whole, 1e-14));
  CHECK(matrix(blend({5, 0, 5}, 0.7)) == Eigen::Matrix2d::Identity());
  // Nearly without extent in one direction: finite, and still the same axes.
  const Eigen::Matrix2d extreme = matrix(blend({1, 0, 1e-30}, 1));
  CHECK(extreme.allFinite());
  CHECK(extreme(0, 0) > 1e7);
}

TEST_CASE("what is positive definite") {
  CHECK(is_positive_definite(skew));
  CHECK(is_positive_definite({1e-200, 0, 1e-200}));
  CHECK(is_positive_definite({1e12, 0, 1}));
  CHECK_FALSE(is_positive_definite({1, 1, 1}));
  CHECK_FALSE(is_positive_definite({1, 2, 1}));
  CHECK_FALSE(is_positive_definite({-1, 0, -1}));
  CHECK_FALSE(is_positive_definite({1, 0, 0}));
  CHECK_FALSE(is_positive_definite({std::numeric_limits<double>::quiet_NaN(), 0, 1}));
  CHECK_FALSE(is_positive_definite({1, 0, std::numeric_limits<double>::infinity()}));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
