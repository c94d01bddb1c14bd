#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/triangle_shape.h"

namespace spectral_conformal::test {
namespace {

using Point = Eigen::Vector3d;

/// The three corners that a shape stands for, in the plane.
std::array<Complex, 3> corners(const TriangleShape& shape) { return {0.0, shape.x1, Complex(shape.x2, shape.y2)}; }

double height_over_longest_side(const TriangleShape& shape) {
  const auto z = corners(shape);
  const double longest = std::max({std::abs(z[1] - z[0]), std::abs(z[2] - z[1]), std::abs(z[0] - z[2])});
  return 2 * shape.area() / (longest * longest);
}

}  // namespace

TEST_SUITE_BEGIN("triangle_shape");

TEST_CASE("laying out keeps lengths, area and the order of the corners") {
  const Point p[3] = {{0.3, -1.2, 4.0}, {2.5, 0.1, 3.2}, {-0.7, 1.9, 5.5}};
  for (int k = 0; k < 3; ++k) {
    const Point &a = p[k], &b = p[(k + 1) % 3], &c = p[(k + 2) % 3];
    const TriangleShape shape = local_isometric_frame(a, b, c);
    const auto z = corners(shape);
    CHECK(std::abs(z[1]) == doctest::Approx((b - a).norm()).epsilon(1e-14));
    CHECK(std::abs(z[2]) == doctest::Approx((c - a).norm()).epsilon(1e-14));
    CHECK(std::abs(z[2] - z[1]) == doctest::Approx((c - b).norm()).epsilon(1e-14));
    // Heron's formula
    const double s = 0.5 * ((b - a).norm() + (c - b).norm() + (a - c).norm());
    const double heron = std::sqrt(s * (s - (b - a).norm()) * (s - (c - b).norm()) * (s - (a - c).norm()));
    CHECK(shape.area() == doctest::Approx(heron).epsilon(1e-13));
    CHECK(triangle_area(a, b, c) == doctest::Approx(heron).epsilon(1e-13));
    CHECK((shape.x1 > 0 && shape.y2 > 0 && !shape.clamped));
  }
}

TEST_CASE("the holomorphic and antiholomorphic parts of f = a p + b conj(p) are 4 |T| a and 4 |T| b") {
  const TriangleShape shape = local_isometric_frame({0, 0, 0}, {1, 2, 0.5}, {-1, 1, 2});
  const auto z = corners(shape);
  const Complex a(0.3, -0.8), b(-1.1, 0.4);
  const auto f = [&](Complex p) { return a * p + b * std::conj(p); };
  const double factor = 4 * shape.area();
  CHECK(std::abs(shape.holomorphic_part(f(z[1]), f(z[2])) - factor * a) < 1e-13 * factor);
  CHECK(std::abs(shape.antiholomorphic_part(f(z[1]), f(z[2])) - factor * b) < 1e-13 * factor);
}

TEST_CASE("a gradient by the corners is the adjoint of the two parts") {
  const TriangleShape shape = local_isometric_frame({0, 0, 0}, {1, 2, 0.5}, {-1, 1, 2});
  const std::array<Complex, 3> z{Complex(0.2, 1.5), Complex(-0.7, 0.4), Complex(2.1, -0.3)};
  const Complex g(0.9, -1.4), h(-0.2, 0.6);
  std::array<Complex, 4> gradient{1.0, 1.0, 1.0, 1.0};
  shape.add_gradient({3, 0, 2}, g, h, gradient.data());
  CHECK(gradient[1] == 1.0);
  const auto dot = [](Complex a, Complex b) { return std::real(std::conj(a) * b); };
  const Complex d1 = z[1] - z[0], d2 = z[2] - z[0];
  const double by_parts = dot(g, shape.holomorphic_part(d1, d2)) + dot(h, shape.antiholomorphic_part(d1, d2));
  const double by_corners = dot(gradient[3] - 1.0, z[0]) + dot(gradient[0] - 1.0, z[1]) + dot(gradient[2] - 1.0, z[2]);
  CHECK(by_corners == doctest::Approx(by_parts).epsilon(1e-13));
  // Without a holomorphic part.
  std::array<Complex, 4> two_parts{}, one_part{};
  shape.add_gradient({3, 0, 2}, 0, h, two_parts.data());
  shape.add_gradient({3, 0, 2}, h, one_part.data());
  CHECK(one_part == two_parts);
}

TEST_CASE("a triangle below the least height is lifted to it, whichever side is its longest") {
  constexpr double least = TriangleShape::min_height;
  for (const double height : {0.0, 0.4 * least}) {
    const Point p[3] = {{0, 0, 0}, {2, 0, 0}, {0.5, 2 * height, 0}};
    for (int k = 0; k < 3; ++k) {
      const TriangleShape shape = local_isometric_frame(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
      CHECK(shape.clamped);
      CHECK(height_over_longest_side(shape) == doctest::Approx(least).epsilon(1e-6));
      CHECK(shape.x1 == doctest::Approx((p[(k + 1) % 3] - p[k]).norm()).epsilon(1e-9));
      CHECK(std::abs(corners(shape)[2]) == doctest::Approx((p[(k + 2) % 3] - p[k]).norm()).epsilon(1e-9));
    }
  }
  CHECK_FALSE(local_isometric_frame({0, 0, 0}, {2, 0, 0}, {0.5, 4 * least, 0}).clamped);
}

TEST_CASE("the relative height is that over the longest side, whichever that is") {
  const double height = 0.25;
  const Eigen::Vector3d corners[3] = {{0, 0, 0}, {2, 0, 0}, {0.7, 2 * height, 0}};
  for (int k = 0; k < 3; ++k) {
    const TriangleShape shape = local_isometric_frame(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
    CHECK(shape.relative_height() == doctest::Approx(height));
  }
  CHECK(local_isometric_frame({0, 0, 0}, {1, 0, 0}, {0.4, 0, 0}).relative_height() ==
        doctest::Approx(TriangleShape::min_height));
}

TEST_CASE("a raised shape has its height over the longest side; fat ones stay") {
  const Eigen::Vector3d cap[3] = {{0, 0, 0}, {2, 0, 0}, {0.7, 1e-12, 0}};
  const Eigen::Vector3d needle[3] = {{0, 0, 0}, {1e-12, 0, 0}, {0, 2, 0}};
  for (const auto& corners : {cap, needle}) {
    for (int k = 0; k < 3; ++k) {
      const TriangleShape shape = local_isometric_frame(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
      const TriangleShape raised = shape.clamped_to(1e-3);
      CHECK(raised.relative_height() == doctest::Approx(1e-3));
      CHECK(raised.area() == doctest::Approx(0.5 * 2 * 2e-3));
      CHECK((raised.clamped == shape.clamped && raised.x1 > 0 && raised.y2 > 0));
    }
  }
  const TriangleShape fat = local_isometric_frame({0, 0, 0}, {1, 0, 0}, {0.3, 0.5, 0});
  CHECK(fat.clamped_to(1e-3).y2 == fat.y2);
}

TEST_CASE("two coinciding corners are clamped, three become equilateral") {
  const Point p(1, 2, 3), q(2, 2, 3);
  for (const TriangleShape& shape :
       {local_isometric_frame(p, p, q), local_isometric_frame(p, q, p), local_isometric_frame(q, p, p)}) {
    CHECK(shape.clamped);
    CHECK(shape.area() > 0);
    CHECK(std::isfinite(shape.x2 / shape.y2));
  }
  const TriangleShape point = local_isometric_frame(p, p, p);
  CHECK(point.clamped);
  const auto z = corners(point);
  CHECK(std::abs(z[1]) == doctest::Approx(std::abs(z[2])));
  CHECK(std::abs(z[1]) == doctest::Approx(std::abs(z[2] - z[1])));
}

TEST_CASE("coordinates that are not finite are clamped") {
  CHECK(local_isometric_frame({0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}).clamped);
}

TEST_CASE("the modulus of a complex number is right where its square overflows or vanishes") {
  for (const double scale : {1e-320, 1e-200, 1e-146, 1e-20, 1.0, 1e140, 1e146, 1e300}) {
    const Complex z(3 * scale, -4 * scale);
    CHECK(modulus(z) == doctest::Approx(std::abs(z)).epsilon(1e-15));
    CHECK(modulus(z) > 0);
  }
  CHECK(modulus(0) == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
