#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "geometry/box_tree.h"
#include "meshes.h"
#include "quality/overlap.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::test {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

double cross(Complex a, Complex b) { return std::imag(std::conj(a) * b); }

/// Area common to two triangles, by clipping one with the half-planes of the other (Sutherland and Hodgman).
double common_area(std::array<Complex, 3> a, std::array<Complex, 3> b) {
  if (cross(b[1] - b[0], b[2] - b[0]) < 0) std::swap(b[1], b[2]);
  std::vector<Complex> polygon(a.begin(), a.end());
  for (int k = 0; k < 3; ++k) {
    const Complex side = b[(k + 1) % 3] - b[k];
    std::vector<Complex> clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Complex p = polygon[i];
      const Complex q = polygon[(i + 1) % polygon.size()];
      const double at_p = cross(side, p - b[k]);
      const double at_q = cross(side, q - b[k]);
      if (at_p >= 0) clipped.push_back(p);
      if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) clipped.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    polygon = std::move(clipped);
  }
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) area += 0.5 * cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return std::abs(area);
}

}  // namespace

TEST_SUITE_BEGIN("overlap");

TEST_CASE("a flat mesh does not overlap, nor does one turned by any angle: neighbors only touch") {
  const Patch patch(flat_grid(12, 9));
  for (const double angle : {0.0, 0.3, 1.0, 2.2}) {
    const ComplexVector z = std::polar(3.0, angle) * flat_map(patch.positions);
    const std::vector<bool> overlapping = overlapping_triangles(patch.chart.triangles, z);
    CHECK(std::count(overlapping.begin(), overlapping.end(), true) == 0);
  }
}

TEST_CASE("agrees with the common area of every pair of scattered triangles") {
  constexpr int n = 60;
  Triangles triangles;
  const ComplexVector random = random_map(4 * n, 11);
  ComplexVector z(3 * n);
  for (int t = 0; t < n; ++t) {
    triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    for (int k = 0; k < 3; ++k) z[3 * t + k] = 4.0 * random[4 * t] + 0.6 * random[4 * t + 1 + k];
  }
  const std::vector<bool> overlapping = overlapping_triangles(triangles, z);
  int expected_count = 0;
  for (int a = 0; a < n; ++a) {
    bool expected = false;
    for (int b = 0; b < n; ++b) {
      expected |=
          a != b && common_area({z[3 * a], z[3 * a + 1], z[3 * a + 2]}, {z[3 * b], z[3 * b + 1], z[3 * b + 2]}) > 1e-9;
    }
    CHECK(overlapping[a] == expected);
    expected_count += expected ? 1 : 0;
  }
  REQUIRE((expected_count > 10 && expected_count < 50));
}

TEST_CASE("one inside another, two that coincide, and a folded neighbor overlap") {
  const Triangles two{{0, 1, 2}, {3, 4, 5}};
  ComplexVector z(6);
  z << 0.0, 4.0, Complex(0, 4), Complex(1, 1), Complex(1.5, 1), Complex(1, 1.5);
  CHECK(overlapping_triangles(two, z) == std::vector<bool>{true, true});
  z.tail(3) = z.head(3);
  CHECK(overlapping_triangles(two, z) == std::vector<bool>{true, true});
  z.head(4) << 0.0, 1.0, Complex(0.5, 1), Complex(0.5, 0.4);
  CHECK(overlapping_triangles({{0, 1, 2}, {1, 0, 3}}, z) == std::vector<bool>{true, true});
  z[3] = Complex(0.5, -0.4);
  CHECK(overlapping_triangles({{0, 1, 2}, {1, 0, 3}}, z) == std::vector<bool>{false, false});
}

TEST_CASE("contacts less deep than rounding do not count, whatever the scale") {
  const Triangles two{{0, 1, 2}, {3, 4, 5}};
  for (const double scale : {1e-200, 1e-12, 1.0, 1e12, 1e200}) {
    ComplexVector z(6);
    for (const double depth : {1e-12, 1e-6}) {
      z << 0.0, 1.0, Complex(0, 1), Complex(0, depth), Complex(0, depth - 1), Complex(1, depth - 1);
      z *= scale;
      CHECK(overlapping_triangles(two, z) == std::vector<bool>{depth > 1e-9, depth > 1e-9});
    }
  }
}

TEST_CASE("a collapsed triangle covers nothing") {
  const Triangles two{{0, 1, 2}, {3, 4, 5}};
  ComplexVector z(6);
  z << 0.0, 4.0, Complex(0, 4), Complex(1, 1), Complex(1, 1), Complex(1, 1);
  CHECK(overlapping_triangles(two, z) == std::vector<bool>{false, false});
  z[4] = Complex(-3, -5);
  CHECK(overlapping_triangles(two, z) == std::vector<bool>{false, false});
  // Nor do two points at one place.
  CHECK(overlapping_triangles(two, ComplexVector::Constant(6, Complex(1, 1))) == std::vector<bool>{false, false});
  z[5] = Complex(1.5, 1);
  CHECK(overlapping_triangles(two, z) == std::vector<bool>{true, true});
}

TEST_CASE("a great many triangles stacked on each other are answered without looking at all pairs") {
  constexpr int n = 300000;
  const Triangles stack(n, {0, 1, 2});
  ComplexVector z(3);
  z << 0.0, 1.0, Complex(0, 1);
  const std::vector<bool> overlapping = overlapping_triangles(stack, z);
  CHECK(std::count(overlapping.begin(), overlapping.end(), true) == n);
}

TEST_CASE("triangles of one face do not count as covering each other, nor what single precision cannot resolve") {
  const Triangles two{{0, 1, 2}, {3, 4, 5}};
  ComplexVector z(6);
  z << 0.0, 1.0, Complex(0, 1), Complex(0.1, 0.1), Complex(1.1, 0.1), Complex(0.1, 1.1);
  CHECK(overlapping_triangles(two, z, {0, 1}) == std::vector<bool>{true, true});
  CHECK(overlapping_triangles(two, z, {7, 7}) == std::vector<bool>{false, false});
  for (const double depth : {1e-7, 1e-6}) {
    z << 0.0, 1.0, Complex(0, 1), Complex(0, depth), Complex(0, depth - 1), Complex(1, depth - 1);
    CHECK(overlapping_triangles(two, z, {}, 2.5e-7)[0] == (depth > 2.5e-7));
    CHECK(overlapping_triangles(two, z)[0]);
    z.array() += 100.0;
    CHECK_FALSE(overlapping_triangles(two, z, {}, 2.5e-7)[0]);
  }
}

TEST_CASE("overlapping faces are found, the two splits of a quad not taken for an overlap") {
  for (const Mesh& mesh : {quad_grid(4, 1), flat_grid(4, 1)}) {
    const Patch patch(mesh);
    ComplexVector z = flat_map(patch.positions);
    CHECK(overlapping_faces(patch.chart, z).empty());
    CHECK(overlapping_faces(patch.chart, z.conjugate()).empty());
    // Folded over at x = 3.2, so that what lies beyond covers what lies before.
    for (Complex& p : z) p = Complex(3.2 - std::abs(p.real() - 3.2), p.imag());
    const std::vector<int> faces = overlapping_faces(patch.chart, z);
    CHECK_FALSE(faces.empty());
    CHECK(std::find(faces.begin(), faces.end(), 0) == faces.end());
    CHECK(std::is_sorted(faces.begin(), faces.end()));
  }
}

TEST_CASE("a quad that folds over covers itself only, unless it reaches its neighbor") {
  const Patch patch(quad_grid(2, 1));
  ComplexVector z = flat_map(patch.positions);
  z[0] = Complex(0.4, 0.8);  // the first quad crosses itself
  CHECK(overlapping_faces(patch.chart, z).empty());
  z[0] = Complex(1.4, 0.5);
  CHECK(overlapping_faces(patch.chart, z) == std::vector<int>{0, 1});
}

TEST_CASE("what many threads find together is what each pair tells") {
  // Ten thousand triangles on several layers, shifted so that most overlap some of another layer.
  const Patch patch(flat_grid(40, 32));
  const auto n = static_cast<int>(patch.positions.rows());
  Triangles triangles;
  constexpr int layers = 4;
  ComplexVector z(layers * n);
  for (int layer = 0; layer < layers; ++layer) {
    for (const auto& [a, b, c] : patch.chart.triangles) {
      triangles.push_back({a + layer * n, b + layer * n, c + layer * n});
    }
    z.segment(layer * n, n) = (flat_map(patch.positions).array() + 35.25 * layer).matrix();
  }
  REQUIRE(triangles.size() > 8192);
  const std::vector<bool> found = overlapping_triangles(triangles, z);
  {
    const ThreadLimit alone(1);
    CHECK(overlapping_triangles(triangles, z) == found);
  }
  const auto box = [&](const std::array<int, 3>& triangle) {
    PlaneBox result{{z[triangle[0]].real(), z[triangle[0]].imag()}, {z[triangle[0]].real(), z[triangle[0]].imag()}};
    for (const int v : triangle) result.include({{z[v].real(), z[v].imag()}, {z[v].real(), z[v].imag()}});
    return result;
  };
  int n_overlapping = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 41) {
    bool expected = false;
    for (std::size_t other = 0; other < triangles.size() && !expected; ++other) {
      if (other == t || !box(triangles[t]).meets(box(triangles[other]))) continue;
      expected = overlapping_triangles({triangles[t], triangles[other]}, z)[0];
    }
    CHECK(found[t] == expected);
    n_overlapping += expected ? 1 : 0;
  }
  CHECK((n_overlapping > 20 && n_overlapping < 200));
}

TEST_CASE("of charts in one map, what their borders prove is what all pairs tell") {
  const Patch with_hole(perforated_grid(3, 3));  // the hole is the cell from (1, 1) to (2, 2)
  const Patch grid(flat_grid(3, 2));
  const ComplexVector small = 0.2 * flat_map(grid.positions);
  const ComplexVector around = flat_map(with_hole.positions);
  ComplexVector folded = small;
  folded[5] += 1.5;
  struct Placed {
    const Patch* patch;
    ComplexVector z;
    bool mirrored;
  };
  const auto at = [](const ComplexVector& z, Complex place) { return ComplexVector(z.array() + place); };
  const ComplexVector mirrored = -small.conjugate();
  // Apart, in the hole, mirrored there, folded beside, over each other, nested twice.
  const std::vector<std::vector<Placed>> maps = {
      {{&with_hole, around, false}, {&grid, at(small, {5, 0}), false}, {&grid, at(small, {9, 0}), false}},
      {{&with_hole, around, false}, {&grid, at(small, {1.2, 1.3}), false}},
      {{&with_hole, around, false}, {&grid, at(mirrored, {1.8, 1.3}), true}},
      {{&with_hole, around, false}, {&grid, at(folded, {4.1, 0}), false}},
      {{&with_hole, around, false}, {&grid, at(small, {0.1, 0.1}), false}},
      {{&grid, at(small, {0, 0}), false}, {&grid, at(small, {0, 0}), false}},
      {{&grid, 20.0 * small, false}, {&grid, at(mirrored, {5, 3}), true}},
  };
  std::vector<bool> any;
  for (const std::vector<Placed>& placed : maps) {
    MapOfCharts map;
    for (const auto& [patch, z, is_mirrored] : placed) {
      std::vector<int> all(patch->chart.triangles.size());
      std::iota(all.begin(), all.end(), 0);
      std::vector<int> faces = all;
      for (int& face : faces) face += static_cast<int>(map.triangles.size());
      map.add(patch->chart, z, is_mirrored, all, faces);
    }
    map.add_loose({Complex(50, 50), Complex(51, 50), Complex(50, 51)}, 1000);
    const ComplexVector z = Eigen::Map<ComplexVector>(map.z.data(), static_cast<Eigen::Index>(map.z.size()));
    const std::vector<bool> found = overlapping_in_map(map);
    CHECK(found == overlapping_triangles(map.triangles, z, map.face));
    any.push_back(std::find(found.begin(), found.end(), true) != found.end());
  }
  CHECK(any == std::vector<bool>{false, false, false, true, true, true, true});
}

TEST_CASE("where boxes of very many pairs meet, a sweep tells what each pair tells (large)") {
  // Wedges about one point, as wide as their distance, some moved, turned or twice; up to rounding of different sizes.
  constexpr int n = 300;
  for (const double rounding : {0.0, 1e-16, 3e-8, 1e-6}) {
    for (const int every : {n, 7, 2}) {
      const ComplexVector noise = random_map(6 * n, 3);
      Triangles triangles;
      std::vector<Complex> points;
      std::vector<int> face;
      const auto add = [&](std::array<Complex, 3> corners) {
        const auto first = static_cast<int>(points.size());
        for (const Complex p : corners) points.push_back(p + Complex(1, 1) + rounding * noise[points.size()]);
        triangles.push_back({first, first + 1, first + 2});
        face.push_back(static_cast<int>(triangles.size()));
      };
      for (int k = 0; k < n; ++k) {
        const Complex from = std::polar(1.0, 2 * pi * k / n);
        const Complex to = std::polar(1.0, 2 * pi * (k + 1) / n);
        add({Complex(0), from, to});
        if (k % every != every - 1) continue;
        if (k % 3 == 0) add({Complex(0), from, to});
        if (k % 3 == 1) add({0.2 * from, 0.6 * to, 0.6 * from});
        if (k % 5 == 0) face.back() = face[face.size() - 2];
      }
      const ComplexVector z = Eigen::Map<ComplexVector>(points.data(), static_cast<Eigen::Index>(points.size()));
      const double resolution = rounding > 0 ? 2.5e-7 : 0;
      std::vector<bool> expected(triangles.size(), false);
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t other = 0; other < t; ++other) {
          if (face[t] == face[other]) continue;
          const std::vector<bool> pair = overlapping_triangles({triangles[t], triangles[other]}, z, {}, resolution);
          if (pair[0]) expected[t] = expected[other] = true;
        }
      }
      CAPTURE(rounding);
      CAPTURE(every);
      CHECK(overlapping_triangles(triangles, z, face, resolution) == expected);
    }
  }
}

TEST_CASE("no triangles") { CHECK(overlapping_triangles({}, {}).empty()); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test
