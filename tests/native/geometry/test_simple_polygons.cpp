#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/signed_area.h"
#include "geometry/simple_polygons.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// Whether a point lies on an edge. All coordinates are small integers, so products are exact.
bool lies_on(Complex p, Complex from, Complex to) {
  return cross(to - from, p - from) == 0 && dot(p - from, p - to) <= 0;
}

bool edges_meet(Complex a, Complex b, Complex c, Complex d) {
  if (lies_on(a, c, d) || lies_on(b, c, d) || lies_on(c, a, b) || lies_on(d, a, b)) return true;
  return cross(b - a, c - a) * cross(b - a, d - a) < 0 && cross(d - c, a - c) * cross(d - c, b - c) < 0;
}

/// By all pairs of edges.
bool no_edges_meet(const std::vector<BoundaryLoop>& polygons, const ComplexVector& z) {
  std::vector<std::array<int, 2>> edges;
  for (const BoundaryLoop& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) edges.push_back({polygon[i], polygon[(i + 1) % polygon.size()]});
  }
  for (const auto& [a, b] : edges) {
    if (z[a] == z[b]) return false;
    for (const auto& [c, d] : edges) {
      if (a == c && b == d) continue;
      if (b == c ? lies_on(z[d], z[a], z[b]) || lies_on(z[a], z[c], z[d])
                 : a != d && edges_meet(z[a], z[b], z[c], z[d])) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

TEST_SUITE_BEGIN("simple_polygons");

TEST_CASE(
    "polygons on a lattice are simple and disjoint if no two of their edges meet, whatever their start and sense") {
  std::mt19937 generator(3);
  const auto below = [&](int n) { return static_cast<int>(generator() % static_cast<unsigned>(n)); };
  std::array<int, 2> n_found{0, 0};
  for (int trial = 0; trial < 20000; ++trial) {
    const int lattice = 3 + below(9);
    std::vector<BoundaryLoop> polygons;
    std::vector<Complex> points;
    const int n_polygons = 1 + below(2);
    for (int k = 0; k < n_polygons; ++k) {
      const Complex at(below(3) * lattice / 2, 0);
      const int n_corners = 3 + below(4);
      BoundaryLoop& polygon = polygons.emplace_back();
      for (int i = 0; i < n_corners; ++i) {
        polygon.push_back(static_cast<int>(points.size()));
        points.push_back(at + Complex(below(lattice), below(lattice)));
      }
    }
    ComplexVector z = Eigen::Map<const ComplexVector>(points.data(), static_cast<Eigen::Index>(points.size()));
    const bool right = no_edges_meet(polygons, z);
    ++n_found[right ? 1 : 0];
    CHECK(are_simple_polygons(polygons, z) == right);
    for (BoundaryLoop& polygon : polygons) std::reverse(polygon.begin(), polygon.end());
    std::rotate(polygons[0].begin(), polygons[0].begin() + 1, polygons[0].end());
    CHECK(are_simple_polygons(polygons, Complex(0, 1) * z) == right);
  }
  CHECK(n_found[0] > 4000);
  CHECK(n_found[1] > 4000);
}

TEST_CASE("edges that leave a corner side by side, tips that touch and corners of two loops at one vertex") {
  ComplexVector z(7);
  z << Complex(0, 0), Complex(4, 0), Complex(0, 4), Complex(4, -1e-300), Complex(-4, 0), Complex(-4, 4), Complex(0, 0);
  CHECK(are_simple_polygons({{0, 1, 2}}, z));
  CHECK(are_simple_polygons({{0, 1, 3}}, z));
  CHECK_FALSE(are_simple_polygons({{0, 1, 4}}, z));             // flat
  CHECK_FALSE(are_simple_polygons({{0, 1, 2}, {0, 4, 5}}, z));  // at one vertex
  CHECK_FALSE(are_simple_polygons({{0, 1, 2}, {6, 4, 5}}, z));  // at one place
  CHECK_FALSE(are_simple_polygons({{0, 6, 1, 2}}, z));          // a collapsed edge
  CHECK(are_simple_polygons({}, z));
}

}  // namespace spectral_conformal::test
