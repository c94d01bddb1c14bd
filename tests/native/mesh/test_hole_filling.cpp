#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "mesh/boundary_loops.h"
#include "mesh/hole_filling.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// The hole as a loop of its own, clockwise as seen from above, beside an outer loop of no interest.
HoleFilling filled(const std::vector<Eigen::Vector2d>& hole, Positions& positions) {
  const auto n = static_cast<Eigen::Index>(hole.size());
  positions.setZero(n + 3, 3);
  BoundaryLoop loop;
  for (Eigen::Index i = 0; i < n; ++i) {
    positions.row(i).head<2>() = hole[static_cast<std::size_t>(i)].transpose();
    loop.insert(loop.begin(), static_cast<int>(i));
  }
  const int first = static_cast<int>(n);
  return fill_holes({{first, first + 1, first + 2}, loop}, 0, positions);
}

/// Area of the filling, every triangle of which must be counterclockwise.
double area(const HoleFilling& filling, const Positions& positions) {
  Positions all(positions.rows() + filling.centers.rows(), 3);
  all << positions, filling.centers;
  double sum = 0;
  for (std::size_t t = 0; t < filling.triangles.size(); ++t) {
    const auto& [a, b, c] = filling.triangles[t];
    const Eigen::Vector3d u = (all.row(b) - all.row(a)).transpose();
    const Eigen::Vector3d v = (all.row(c) - all.row(a)).transpose();
    const double triangle = 0.5 * u.cross(v).z();
    CHECK(triangle > 0);
    sum += filling.triangle_weights[t] * triangle;
  }
  return sum;
}

}  // namespace

TEST_SUITE_BEGIN("hole_filling");

TEST_CASE("a star-shaped hole is closed by a fan around its barycenter") {
  Positions positions;
  std::vector<Eigen::Vector2d> hexagon;
  for (int i = 0; i < 6; ++i) hexagon.push_back(Eigen::Rotation2Dd(i * 1.0471975511965976) * Eigen::Vector2d(2, 0));
  const HoleFilling filling = filled(hexagon, positions);
  CHECK(filling.triangles.size() == 6);
  REQUIRE(filling.centers.rows() == 1);
  CHECK(filling.centers.row(0).norm() < 1e-15);
  CHECK(area(filling, positions) == doctest::Approx(6 * std::sqrt(3.0)));
}

TEST_CASE("a square hole gets both splits, a triangle itself") {
  Positions positions;
  CHECK(area(filled({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, positions), positions) == doctest::Approx(1));
  CHECK(area(filled({{0, 0}, {2, 0}, {0, 1}}, positions), positions) == doctest::Approx(1));
}

TEST_CASE("a hole that is not star-shaped is triangulated inside itself") {
  Positions positions;
  const HoleFilling filling =
      filled({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 2}, {2, 2}, {2, 1}, {0, 1}}, positions);  // a C
  CHECK(filling.centers.rows() == 0);
  CHECK(filling.triangles.size() == 6);
  CHECK(area(filling, positions) == doctest::Approx(7));
}

TEST_CASE("the filling of a patch agrees with its orientation and leaves the outer loop open") {
  const Patch patch(perforated_grid(10, 7));
  const int outer = outer_loop(patch.chart.boundary_loops, patch.positions);
  const HoleFilling filling = fill_holes(patch.chart.boundary_loops, outer, patch.positions);
  CHECK(filling.triangles.size() == filling.triangle_weights.size());
  Positions positions(patch.positions.rows() + filling.centers.rows(), 3);
  positions << patch.positions, filling.centers;
  Mesh closed;
  for (Eigen::Index v = 0; v < positions.rows(); ++v) closed.points.emplace_back(positions.row(v).transpose());
  for (const auto& t : patch.chart.triangles) closed.add({t[0], t[1], t[2]});
  for (std::size_t t = 0; t < filling.triangles.size(); ++t) {
    // Of the two splits of a quad the first.
    if (filling.triangle_weights[t] < 1 && t % 4 > 1) continue;
    closed.add({filling.triangles[t][0], filling.triangles[t][1], filling.triangles[t][2]});
  }
  const Patch filled_patch(closed);
  CHECK(filled_patch.chart.boundary_loops.size() == 1);
  CHECK(filled_patch.chart.reversed_faces == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
