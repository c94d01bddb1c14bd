#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "geometry/polygon_triangulation.h"
#include "graph/mixed_bits.h"

namespace spectral_conformal::test {
namespace {

using Points = std::vector<std::array<double, 2>>;

/// The polygon in a tilted plane of 3D, beginning with the given corner.
Positions tilted(const Points& polygon, std::size_t first = 0) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  Positions corners(polygon.size(), 3);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& p = polygon[(first + i) % polygon.size()];
    corners.row(i) = (turn * Eigen::Vector3d(p[0], p[1], 0)).transpose() + Eigen::RowVector3d(5, -3, 2);
  }
  return corners;
}

PolygonTriangulation triangulate(const Positions& corners) {
  PolygonTriangulation result;
  triangulate_polygon(corners, result);
  REQUIRE(result.triangle_weights.size() == result.triangles.size());
  return result;
}

double area_of_triangle(const Points& polygon, const std::array<int, 3>& triangle) {
  const auto &a = polygon[triangle[0]], &b = polygon[triangle[1]], &c = polygon[triangle[2]];
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

double shoelace(const Points& polygon) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return area;
}

using TriangleSet = std::set<std::array<int, 3>>;

/// Triangles as sorted corners, counted from corner 0 of the polygon as given.
TriangleSet triangles_of(const PolygonTriangulation& result, int first, int n) {
  TriangleSet set;
  for (auto triangle : result.triangles) {
    for (int& corner : triangle) corner = (corner + first) % n;
    std::sort(triangle.begin(), triangle.end());
    set.insert(triangle);
  }
  return set;
}

const Points l_shape{{0, 0}, {3, 0}, {3, 1}, {1.1, 1}, {1.1, 4}, {0, 4}};
const Points comb{{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1.2}, {5, 3}, {4, 3}, {4, 1}, {2, 1}, {2, 3.5}, {0, 3}};
const Points arrow{{0, 0}, {4, 1}, {0, 2.2}, {1, 1}};  // concave at corner 3

}  // namespace

TEST_SUITE_BEGIN("polygon_triangulation");

TEST_CASE("concave polygons are filled without overlap by the same triangles, whatever corner comes first") {
  for (const Points& polygon : {l_shape, comb}) {
    const int n = static_cast<int>(polygon.size());
    const TriangleSet expected = triangles_of(triangulate(tilted(polygon)), 0, n);
    for (int first = 0; first < n; ++first) {
      const PolygonTriangulation result = triangulate(tilted(polygon, first));
      CHECK(result.simple);
      CHECK(static_cast<int>(result.triangles.size()) == n - 2);
      CHECK(triangles_of(result, first, n) == expected);
      double area = 0;
      for (std::size_t t = 0; t < result.triangles.size(); ++t) {
        auto triangle = result.triangles[t];
        for (int& corner : triangle) corner = (corner + first) % n;
        CHECK(area_of_triangle(polygon, triangle) > 0);
        CHECK(result.triangle_weights[t] == 1);
        area += area_of_triangle(polygon, triangle);
      }
      CHECK(area == doctest::Approx(shoelace(polygon)).epsilon(1e-14));
    }
  }
}

TEST_CASE("a convex quad has both splits at half weight") {
  const Points quad{{0, 0}, {2, 0.1}, {2.5, 1.5}, {0.2, 1}};
  for (int first = 0; first < 4; ++first) {
    const PolygonTriangulation result = triangulate(tilted(quad, first));
    CHECK(result.simple);
    CHECK(triangles_of(result, first, 4) == TriangleSet{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}});
    CHECK(result.triangle_weights == std::vector<TriangleWeight>(4, split_of_quad));
  }
}

TEST_CASE("a quad that is bent but convex along its diagonals' normal has both splits") {
  Positions corners(4, 3);
  corners << 0, 0, 0, 1, 0, 0.5, 1, 1, 0, 0, 1, 0.5;
  CHECK(triangulate(corners).triangles.size() == 4);
}

TEST_CASE("a concave quad has the one split that stays inside, whatever corner comes first") {
  for (int first = 0; first < 4; ++first) {
    const PolygonTriangulation result = triangulate(tilted(arrow, first));
    CHECK(result.simple);
    CHECK(triangles_of(result, first, 4) == TriangleSet{{0, 1, 3}, {1, 2, 3}});
    CHECK(result.triangle_weights == std::vector<TriangleWeight>(2));
  }
}

TEST_CASE("a quad with a straight corner is split at that corner") {
  const Points straight{{0, 0}, {1, 0}, {2, 0}, {0.5, 1}};
  for (int first = 0; first < 4; ++first) {
    CHECK(triangles_of(triangulate(tilted(straight, first)), first, 4) == TriangleSet{{0, 1, 3}, {1, 2, 3}});
  }
}

TEST_CASE("a triangle is itself") {
  const PolygonTriangulation result = triangulate(tilted({{0, 0}, {1, 0}, {0, 1}}));
  CHECK(result.triangles == std::vector<std::array<int, 3>>{{0, 1, 2}});
  CHECK(result.triangle_weights == std::vector<TriangleWeight>(1));
}

TEST_CASE("collinear corners in a larger polygon are no obstacle") {
  const Points polygon{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}};
  const PolygonTriangulation result = triangulate(tilted(polygon));
  CHECK(result.simple);
  double area = 0;
  for (const auto& triangle : result.triangles) area += area_of_triangle(polygon, triangle);
  CHECK(area == doctest::Approx(4));
}

TEST_CASE("polygons without a simple triangulation get a fan that uses every corner, and say so") {
  Positions coincident = tilted(l_shape);
  coincident.row(4) = coincident.row(1);
  Positions unbounded = tilted(l_shape);
  unbounded(2, 1) = std::numeric_limits<double>::quiet_NaN();
  const Points star{{1, 0}, {-0.8, 0.6}, {0.3, -0.95}, {0.3, 0.95}, {-0.8, -0.6}};
  for (const Positions& corners : {tilted(star), coincident, unbounded}) {
    const int n = static_cast<int>(corners.rows());
    const PolygonTriangulation result = triangulate(corners);
    CHECK_FALSE(result.simple);
    CHECK(static_cast<int>(result.triangles.size()) == n - 2);
    std::set<int> used;
    for (const auto& triangle : result.triangles) used.insert(triangle.begin(), triangle.end());
    CHECK(static_cast<int>(used.size()) == n);
  }
}

TEST_CASE("what crosses itself everywhere is found out without clipping ears, which would take minutes") {
  constexpr int n = 30000;
  Positions corners(n, 3);
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::uint64_t>(i);
    corners.row(i) << pseudo_random(k, 1), pseudo_random(k, 2), 0;
  }
  PolygonTriangulation triangulation;
  triangulate_polygon(corners, triangulation);
  CHECK_FALSE(triangulation.simple);
  CHECK(triangulation.triangles.size() == n - 2);
  // Round and round a triangle.
  for (int i = 0; i < n; ++i) corners.row(i) << (i % 3 == 0 ? 1 : 0), (i % 3 == 1 ? 1 : 0), 0;
  triangulate_polygon(corners, triangulation);
  CHECK_FALSE(triangulation.simple);
}

TEST_CASE("polygons on a line or at a point have as many triangles, and cross nothing") {
  for (const Positions& corners :
       {Positions(Positions::Ones(5, 3)), tilted({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}})}) {
    const PolygonTriangulation result = triangulate(corners);
    CHECK(result.simple);
    CHECK(result.triangles.size() == 3);
  }
}

TEST_CASE("polygons to and fro on a line off the axes, whose normal is rounding, have no area") {
  constexpr double x = 0x1.3f3a0e28bedd2p-1;
  constexpr double y = 0x1.904c37505de4bp-1;
  constexpr double z = 0x1.99999999999a0p-3;
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    Positions corners(5 + static_cast<Eigen::Index>(trial % 4), 3);
    for (Eigen::Index i = 0; i < corners.rows(); ++i) {
      const double step = pseudo_random(trial, static_cast<std::uint64_t>(i));
      corners.row(i) << x, y, z * std::floor(4 * step);
    }
    const PolygonTriangulation result = triangulate(corners);
    CHECK(result.simple);
    CHECK(static_cast<Eigen::Index>(result.triangles.size()) == corners.rows() - 2);
  }
  Positions corners(7, 3);
  const std::array heights{z, -0x1.9999999999998p-3, -0x1.3333333333333p-1, 1.0, z, -0x1.3333333333333p-1, 1.0};
  for (Eigen::Index i = 0; i < 7; ++i) corners.row(i) << x, y, heights[static_cast<std::size_t>(i)];
  CHECK(triangulate(corners).triangles.size() == 5);
}

TEST_CASE("bridges, edges through corners and lobes: every place is covered once, corners at one place told apart") {
  const Points keyhole{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}};
  const Points through_a_corner{{0, 0}, {1, 2}, {3, 3}, {0, 3}, {1, 3}};
  const Points lobes{{0, 0}, {2, 0}, {2, 2}, {0, 0}, {-1, 3}, {-2, 0}};
  for (const Points& polygon : {keyhole, through_a_corner, lobes}) {
    const PolygonTriangulation result = triangulate(tilted(polygon));
    CHECK(result.simple);
    REQUIRE(result.triangles.size() == polygon.size() - 2);
    std::set<int> used;
    double area = 0;
    for (const auto& triangle : result.triangles) {
      CHECK(area_of_triangle(polygon, triangle) > -1e-9);
      area += area_of_triangle(polygon, triangle);
      used.insert(triangle.begin(), triangle.end());
    }
    CHECK(area == doctest::Approx(shoelace(polygon)));
    CHECK(used.size() == polygon.size());
  }
}

TEST_CASE("a quad without area gets both splits; one that crosses itself says so") {
  Positions line(4, 3), crossed(4, 3), coincident(4, 3);
  line << 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0;
  crossed << 0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0;
  coincident << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0;
  for (const Positions& corners : {line, crossed, coincident}) CHECK(triangulate(corners).triangles.size() == 4);
  CHECK(triangulate(line).simple);
  CHECK(triangulate(coincident).simple);
  CHECK_FALSE(triangulate(crossed).simple);
}

TEST_CASE("the result replaces what was there before") {
  PolygonTriangulation result;
  triangulate_polygon(tilted(comb), result);
  triangulate_polygon(tilted(arrow), result);
  CHECK(result.triangles.size() == 2);
  CHECK(result.triangle_weights.size() == 2);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
