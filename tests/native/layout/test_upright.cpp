#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "layout/upright.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

using Position = std::function<Eigen::Vector3d(double, double)>;

/// A grid of columns x rows unit cells in the plane, taken into space by `position`, and the plane as its map.
struct Sheet {
  Patch patch;
  ConformalEnergy energy;
  ComplexVector flat;

  Sheet(const Mesh& plane, const Position& position)
      : patch(moved(plane, position)), energy(patch.energy(Weights::uniform)), flat(flat_map(Patch(plane).positions)) {
    flat.array() -= flat.mean();
  }
  static Mesh moved(Mesh mesh, const Position& position) {
    for (auto& p : mesh.points) p = position(p.x(), p.y());
    return mesh;
  }
  /// The angle in degrees by which `z`, the plane by default, is turned to stand.
  double angle(const ComplexVector& z) const {
    return std::arg(upright_turn(z, energy, patch.outer(), patch.positions)) * 180 / pi;
  }
  double angle() const { return angle(flat); }
};

Sheet sheet(int columns, int rows, const Position& position) { return {quad_grid(columns, rows), position}; }

/// A wall that faces -y, leaning to the left by `degrees`.
Position leaning(double degrees) {
  const Complex turn = std::polar(1.0, degrees * pi / 180);
  return [turn](double x, double y) {
    const Complex p = turn * Complex(x, y);
    return Eigen::Vector3d(p.real(), 0, p.imag());
  };
}

Eigen::Vector3d floor_of(double x, double y) { return {x, y, 0}; }

/// An isosceles triangle, twice as high as wide, of whose sides none is upright: its smallest rectangle leans.
Mesh gable() {
  Mesh mesh;
  for (int row = 0; row <= 4; ++row) {
    for (int k = 0; k <= row; ++k) mesh.points.emplace_back((2 * k - row) * 0.5, 2.0 * (4 - row), 0.0);
  }
  const auto at = [](int row, int k) { return row * (row + 1) / 2 + k; };
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k <= row; ++k) {
      mesh.add({at(row, k), at(row + 1, k), at(row + 1, k + 1)});
      if (k < row) mesh.add({at(row, k), at(row + 1, k + 1), at(row, k + 1)});
    }
  }
  return mesh;
}

/// An irregular round outline about a point, without straight parts.
Mesh pebble() {
  Mesh mesh;
  mesh.points.emplace_back(0, 0, 0);
  constexpr int n = 60;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * pi * k / n;
    const double radius = 1 + 0.06 * std::cos(2 * angle) + 0.04 * std::sin(3 * angle) + 0.02 * std::sin(7 * k);
    mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    mesh.add({0, 1 + k, 1 + (k + 1) % n});
  }
  return mesh;
}

/// The turns differ by less than `tolerance` degrees, as angles.
bool is_near(double degrees, double expected, double tolerance = 0.1) {
  return std::abs(std::remainder(degrees - expected, 360)) < tolerance;
}

}  // namespace

TEST_SUITE_BEGIN("upright");

TEST_CASE("a wall stands as it does in space, higher than wide or not, from whatever side it is seen") {
  for (const auto& [columns, rows] : {std::pair(8, 3), std::pair(3, 8), std::pair(5, 5)}) {
    CHECK(is_near(sheet(columns, rows, leaning(0)).angle(), 0));
    CHECK(is_near(sheet(columns, rows, [](double x, double y) { return Eigen::Vector3d(0, x, y); }).angle(), 0));
    CHECK(is_near(sheet(columns, rows, [](double x, double y) { return Eigen::Vector3d(x, 0, -y); }).angle(), 180));
    CHECK(is_near(sheet(columns, rows, [](double x, double y) { return Eigen::Vector3d(y, 3, x); }).angle(), 90));
  }
}

TEST_CASE("the turn does not depend on how the map is turned, moved and scaled") {
  const Sheet wall = sheet(8, 3, leaning(0));
  for (const double degrees : {10.0, 100.0, 190.0, 280.0}) {
    const ComplexVector turned = (std::polar(1e-4, degrees * pi / 180) * wall.flat).array() + Complex(5, -2);
    CHECK(is_near(wall.angle(turned), -degrees));
  }
}

TEST_CASE("a leaning wall gets its borders upright, by the nearest quarter turn") {
  for (const double degrees : {-40.0, -10.0, 10.0, 40.0}) CHECK(is_near(sheet(8, 3, leaning(degrees)).angle(), 0));
  for (const double degrees : {50.0, 80.0, 100.0}) CHECK(is_near(sheet(8, 3, leaning(degrees)).angle(), 90));
  for (const double degrees : {150.0, 200.0}) CHECK(is_near(sheet(8, 3, leaning(degrees)).angle(), 180));
}

TEST_CASE("of two quarter turns that are equally near always the same is taken") {
  // Up to a degree beside 45 the first coordinate decides; the square's quarter turns differ in nothing else.
  for (const double degrees : {44.5, 45 - 1e-6, 45.0, 45 + 1e-6, 45.5}) {
    CHECK(is_near(sheet(5, 5, leaning(degrees)).angle(), sheet(5, 5, leaning(45)).angle()));
    CHECK(is_near(sheet(12, 3, leaning(degrees)).angle(), sheet(12, 3, leaning(45)).angle()));
  }
}

TEST_CASE("a floor is seen from above, and so is a roof of small slope; a steep one stands") {
  for (const auto& [columns, rows] : {std::pair(8, 3), std::pair(5, 5)}) {
    CHECK(is_near(sheet(columns, rows, floor_of).angle(), 0));
    const auto roof = [](double slope) {
      return [slope](double x, double y) { return Eigen::Vector3d(x, y, -slope * y); };
    };
    CHECK(is_near(sheet(columns, rows, roof(0.2)).angle(), 0));
    CHECK(is_near(sheet(columns, rows, roof(0.4)).angle(), 180));
  }
}

TEST_CASE("a surface along the first coordinate alone has it to the right") {
  // Folded over so often that the other coordinates do not grow across it.
  const Sheet folded = sheet(8, 16, [](double x, double y) {
    return Eigen::Vector3d(x, std::sin(y * pi / 2), 1 - std::abs(std::remainder(y, 2.0)));
  });
  CHECK(is_near(folded.angle(), 0));
}

TEST_CASE("a symmetric map stands on its axis though a smaller rectangle leans") {
  const Mesh plane = gable();
  CHECK(is_near(Sheet(plane, leaning(0)).angle(), 0));
  CHECK(is_near(Sheet(plane, leaning(20)).angle(), 0));
  CHECK(is_near(Sheet(plane, leaning(160)).angle(), 180));
  // Seen from above, too, wherever it points.
  CHECK(is_near(Sheet(plane, floor_of).angle(), 0));
  const double lying = Sheet(plane, [](double x, double y) { return Eigen::Vector3d(y, -x, 0); }).angle();
  CHECK((is_near(lying, 0) || is_near(lying, 180)));
  // Sheared, with no right angle, it is not symmetric any more and has a side of its own upright.
  const Sheet sheared(plane, [](double x, double y) { return Eigen::Vector3d(x, 0, y); });
  ComplexVector z = sheared.flat;
  for (Complex& p : z) p += 0.6 * p.imag();
  CHECK_FALSE(is_near(sheared.angle(z), 0));
}

TEST_CASE("straight outlines decide before axes and small rectangles: a letter L, a cross, stairs") {
  // Of squares in a plane, by row and column.
  const std::vector<std::vector<std::pair<int, int>>> shapes{
      {{0, 0}, {0, 1}, {1, 0}},
      {{0, 1}, {1, 0}, {1, 1}, {1, 2}, {2, 1}},
      {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 1}, {3, 0}},
  };
  for (const auto& squares : shapes) {
    Mesh mesh;
    std::map<int, int> number;
    for (const auto& [row, column] : squares) {
      std::vector<int> corners;
      for (const int v : {6 * row + column, 6 * row + column + 1, 6 * row + column + 7, 6 * row + column + 6}) {
        const auto [found, is_new] = number.emplace(v, static_cast<int>(mesh.points.size()));
        if (is_new) mesh.points.emplace_back(v % 6, v / 6, 0);
        corners.push_back(found->second);
      }
      mesh.add(corners);
    }
    CHECK(is_near(Sheet(mesh, floor_of).angle(), 0));
    for (const double degrees : {-40.0, 0.0, 30.0}) CHECK(is_near(Sheet(mesh, leaning(degrees)).angle(), 0));
  }
}

TEST_CASE("diagonals decide nothing: a triangulated square stands as its quad, whatever they are") {
  Mesh square;
  square.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.add({0, 1, 2});
  square.add({0, 2, 3});
  const Mesh grid = quad_grid(4, 4);
  Mesh split;
  split.points = grid.points;
  for (int face = 0; face < grid.n_faces(); ++face) {
    const int* v = grid.corners.data() + grid.offsets[face];
    // All along one way but in a part of the rows.
    const int first = face < 5 ? 1 : 0;
    split.add({v[first], v[first + 1], v[first + 2]});
    split.add({v[first], v[first + 2], v[(first + 3) % 4]});
  }
  for (const Mesh& mesh : {square, split}) {
    CHECK(is_near(Sheet(mesh, floor_of).angle(), 0));
    for (const double degrees : {-40.0, 0.0, 30.0}) CHECK(is_near(Sheet(mesh, leaning(degrees)).angle(), 0));
  }
}

TEST_CASE("a round outline without symmetry is upright to 2 degrees, an oblong one by quarter turns") {
  for (double degrees = -180; degrees < 180; degrees += 10) {
    CHECK(is_near(Sheet(pebble(), leaning(degrees)).angle(), degrees, 2));
  }
  Mesh oblong = pebble();
  for (auto& p : oblong.points) p.x() *= 3;
  CHECK_FALSE(is_near(Sheet(oblong, leaning(30)).angle(), 30));
}

TEST_CASE("rounding decides nothing: not of a square, a regular outline, a saddle or a dome") {
  const auto saddle = [](double x, double y) {
    return Eigen::Vector3d(x - 3, y - 3, 0.3 * ((x - 3) * (x - 3) - (y - 3) * (y - 3)));
  };
  const auto dome = [](double x, double y) {
    return Eigen::Vector3d(x - 3, y - 3, -0.3 * ((x - 3) * (x - 3) + (y - 3) * (y - 3)));
  };
  for (const Position& position : {Position(floor_of), leaning(0), leaning(45), Position(saddle), Position(dome)}) {
    const Sheet exact = sheet(6, 6, position);
    const ComplexVector noise = random_map(exact.flat.size());
    for (const double degrees : {0.0, 77.0, 200.0}) {
      const ComplexVector z = std::polar(1.0, degrees * pi / 180) * (exact.flat + 1e-6 * noise);
      CHECK(is_near(exact.angle(z), exact.angle() - degrees));
    }
  }
}

TEST_CASE("where no coordinate tells directions apart the shape does: higher than wide, the broader end down") {
  // Even functions of the map about its center have no linear part.
  const Position even = [](double x, double y) {
    return Eigen::Vector3d(std::cos(pi * x), std::cos(pi * y), 0.1 * std::cos(pi * (x + y)));
  };
  CHECK(is_near(2 * sheet(4, 8, even).angle(), 0));
  CHECK(is_near(2 * sheet(8, 4, even).angle(), 180));
  const Sheet point(gable(), [](double, double) { return Eigen::Vector3d(1, 2, 3); });
  for (const double degrees : {0.0, 90.0, 200.0}) {
    CHECK(is_near(point.angle(std::polar(1.0, degrees * pi / 180) * point.flat), -degrees));
  }
}

TEST_CASE("an outline is straightened by at most an eighth turn, by its axis, its edges or its hull") {
  const std::vector<std::vector<Complex>> straight{
      {{0, 0}, {3, 0}, {3, 1}, {0, 1}},                                                                  // a rectangle
      {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}},                                                  // a letter L
      {{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}},  // a cross
      {{-1, 0}, {1, 0}, {0, 4}},                                                                         // a gable
      {{0, 0}, {4, 0}, {4, 2}, {1, 2}},                                                                  // a trapezoid
  };
  for (const std::vector<Complex>& polygon : straight) {
    const auto angle = [&](double degrees) {
      IslandOutline outline;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Complex turn = std::polar(1.0, degrees * pi / 180);
        outline.edges.push_back({turn * polygon[i], turn * polygon[(i + 1) % polygon.size()]});
      }
      return std::arg(straight_turn(outline)) * 180 / pi;
    };
    CAPTURE(polygon.size());
    CHECK(angle(0) == 0);
    for (const double degrees : {-44.0, -10.0, 0.01, 30.0}) CHECK(angle(degrees) == doctest::Approx(-degrees));
    CHECK(angle(100) == doctest::Approx(-10));
  }
  CHECK(straight_turn({}) == 1.0);
  CHECK(straight_turn({{{1, 1}, {1, 1}}}) == 1.0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
