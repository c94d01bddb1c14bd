#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "meshes.h"
#include "quality/flips.h"
#include "quality/map_degree.h"
#include "quality/overlap.h"

namespace spectral_conformal::test {
namespace {

bool certainly_injective(const Patch& patch, const ComplexVector& z) {
  return non_positive_triangles(patch.chart.triangles, z).empty() &&
         has_degree_at_most_one(patch.chart.boundary_loops, z);
}

bool overlaps(const Patch& patch, const ComplexVector& z) {
  const std::vector<bool> overlapping = overlapping_triangles(patch.chart.triangles, z);
  return std::find(overlapping.begin(), overlapping.end(), true) != overlapping.end();
}

bool folds(const Patch& patch, const ComplexVector& z) {
  return std::any_of(patch.chart.triangles.begin(), patch.chart.triangles.end(), [&](const std::array<int, 3>& t) {
    return std::imag(std::conj(z[t[1]] - z[t[0]]) * (z[t[2]] - z[t[0]])) <= 0;
  });
}

ComplexVector mapped(const Patch& patch, const std::function<Complex(double, double)>& map) {
  ComplexVector z(patch.positions.rows());
  for (Eigen::Index v = 0; v < z.size(); ++v) z[v] = map(patch.positions(v, 0), patch.positions(v, 1));
  return z;
}

/// Bends a strip along x to an arc of the given angle per unit of x, with radius 10 in its middle.
std::function<Complex(double, double)> bent(double angle, double middle, double widening = 0) {
  return [=](double x, double y) { return std::polar(10 + widening * x + y - middle, -angle * x); };
}

}  // namespace

TEST_SUITE_BEGIN("map_degree");

TEST_CASE("flat patches, with and without holes, are injective; mirrored ones are not oriented") {
  for (const Mesh& mesh : {flat_grid(12, 9), perforated_grid(12, 9)}) {
    const Patch patch(mesh);
    const ComplexVector z = flat_map(patch.positions);
    CHECK(certainly_injective(patch, std::polar(1e-8, 0.7) * z));
    CHECK(certainly_injective(patch, (z.array() + Complex(1e6, -1e6)).matrix()));
    CHECK_FALSE(certainly_injective(patch, z.conjugate()));
  }
}

TEST_CASE("a slit of one edge, whose ends stay whole, leaves a patch injective") {
  Mesh slit = flat_grid(12, 9);
  slit.seams = {{30, 31}, {60, 61}};
  const Patch patch(slit);
  REQUIRE(patch.chart.boundary_loops.size() == 3);
  CHECK(certainly_injective(patch, flat_map(patch.positions)));
  CHECK_FALSE(certainly_injective(patch, mapped(patch, bent(0.6, 4))));
}

TEST_CASE("a strip bent past itself overlaps without a flip, one that spirals outward does not overlap") {
  const Patch patch(flat_grid(40, 4));
  struct Strip {
    double angle;
    double widening;
    bool overlapping;
  };
  constexpr Strip strips[] = {
      {0.14, 0, false}, {0.2, 0, true}, {0.35, 0, true}, {0.25, 0.25, false}, {0.25, 0.05, true}};
  for (const Strip& strip : strips) {
    CAPTURE(strip.angle);
    CAPTURE(strip.widening);
    const ComplexVector z = mapped(patch, bent(strip.angle, 2, strip.widening));
    REQUIRE_FALSE(folds(patch, z));
    CHECK(overlaps(patch, z) == strip.overlapping);
    CHECK(certainly_injective(patch, z) != strip.overlapping);
  }
}

TEST_CASE("a boundary that winds twice around a branch point, without a flip") {
  Mesh fan;
  constexpr int n = 24;
  for (int i = 0; i < n; ++i) fan.points.emplace_back(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0);
  fan.points.emplace_back(0, 0, 0);
  for (int i = 0; i < n; ++i) fan.add({i, (i + 1) % n, n});
  const Patch patch(fan);
  // Farther out on the second round, so that the boundary crosses itself in one place only.
  ComplexVector z(n + 1);
  for (int i = 0; i < n; ++i) z[i] = std::polar(1 + 0.05 * i, 4 * pi * i / n);
  z[n] = 0;
  REQUIRE_FALSE(folds(patch, z));
  CHECK(overlaps(patch, z));
  CHECK_FALSE(certainly_injective(patch, z));
}

TEST_CASE("an annulus that winds twice") {
  const Patch patch(perforated_grid(3, 3));
  REQUIRE(patch.chart.boundary_loops.size() == 2);
  ComplexVector squared = flat_map(patch.positions);
  for (Complex& p : squared) p = (p - Complex(1.5, 1.5)) * (p - Complex(1.5, 1.5));
  CHECK(overlaps(patch, squared));
  CHECK_FALSE(has_degree_at_most_one(patch.chart.boundary_loops, squared));
}

TEST_CASE("two loops that are simple, disjoint and counterclockwise, without a flip") {
  // w + 1 / w maps an annulus about |w| = 1 two to one, branching at 1 and -1, its two loops to confocal ellipses.
  constexpr int n = 24;
  constexpr int inner = -3;
  constexpr int outer = 5;
  const double step = 2 * pi / n;
  Mesh annulus;
  for (int k = inner; k <= outer; ++k) {
    for (int i = 0; i < n; ++i) {
      const Complex w = std::polar(std::exp(0.5 * std::sqrt(3.0) * step * k), step * (i + (k % 2 == 0 ? 0 : 0.5)));
      annulus.points.emplace_back(w.real(), w.imag(), 0);
    }
  }
  for (int k = 0; k < outer - inner; ++k) {
    const auto vertex = [&](int ring, int i) { return ring * n + (i + n) % n; };
    const int shift = (k + inner) % 2 == 0 ? 0 : 1;
    for (int i = 0; i < n; ++i) {
      annulus.add({vertex(k, i), vertex(k + 1, i + shift - 1), vertex(k + 1, i + shift)});
      annulus.add({vertex(k, i), vertex(k + 1, i + shift), vertex(k, i + 1)});
    }
  }
  const Patch patch(annulus);
  ComplexVector z = flat_map(patch.positions);
  REQUIRE(certainly_injective(patch, z));
  for (Complex& w : z) w = w + 1.0 / w;
  REQUIRE(non_positive_triangles(patch.chart.triangles, z).empty());
  for (const BoundaryLoop& loop : patch.chart.boundary_loops) REQUIRE(shoelace_area(loop, z) > 0);
  CHECK(overlaps(patch, z));
  CHECK_FALSE(has_degree_at_most_one(patch.chart.boundary_loops, z));
}

TEST_CASE("collapsed maps are not injective, tiny ones are") {
  const Patch patch(flat_grid(6, 3));
  const ComplexVector flat = flat_map(patch.positions);
  const BoundaryLoop& loop = patch.outer();
  ComplexVector collapsed = flat;
  collapsed[loop[0]] = collapsed[loop[1]];
  CHECK_FALSE(certainly_injective(patch, collapsed));
  CHECK_FALSE(certainly_injective(patch, ComplexVector::Zero(flat.size())));
  CHECK(certainly_injective(patch, 1e-200 * flat));
}

TEST_CASE("suspects are those on which the boundary lies, those covered twice, and those that are flipped") {
  const auto suspects = [](const Patch& patch, const ComplexVector& z) {
    return overlap_suspects(patch.chart.triangles, patch.chart.boundary_loops, z);
  };
  const auto is_among = [](int t, const std::vector<int>& some) {
    return std::binary_search(some.begin(), some.end(), t);
  };
  // A strip that ends on its own beginning: far from the end nothing is suspected, but what overlaps is.
  for (const int width : {1, 4}) {
    CAPTURE(width);
    const Patch strip(flat_grid(40, width));
    const ComplexVector bent_back = mapped(strip, bent(0.17, 0.5 * width));
    const std::vector<bool> overlapping = overlapping_triangles(strip.chart.triangles, bent_back);
    const std::vector<int> found = suspects(strip, bent_back);
    for (int t = 0; t < static_cast<int>(overlapping.size()); ++t) {
      if (overlapping[t]) CHECK(is_among(t, found));
    }
    CHECK(found.size() < overlapping.size() / 2);
    CHECK(suspects(strip, mapped(strip, bent(0.14, 0.5 * width))).empty());
  }
  // Where a map winds twice, the boundary meets no more than a few triangles.
  const Patch annulus(perforated_grid(3, 3));
  ComplexVector squared = flat_map(annulus.positions);
  for (Complex& p : squared) p = (p - Complex(1.5, 1.5)) * (p - Complex(1.5, 1.5));
  CHECK(suspects(annulus, squared).size() == annulus.chart.triangles.size());
  // The outline of two patches that touch in a corner is not simple, but covers nothing twice.
  Mesh mesh = flat_grid(8, 8);
  const Patch patch(mesh);
  ComplexVector touching = flat_map(patch.positions);
  const BoundaryLoop& loop = patch.outer();
  const Complex opposite = touching[loop[loop.size() / 2]];
  touching[loop[0]] = opposite;
  CHECK_FALSE(has_degree_at_most_one(patch.chart.boundary_loops, touching));
  CHECK_FALSE(suspects(patch, touching).empty());
  CHECK(suspects(patch, flat_map(patch.positions).conjugate()).size() == patch.chart.triangles.size());
}

TEST_CASE("agrees with the test of all triangles on random maps") {
  int injective = 0;
  int unseen_by_flips = 0;
  int folded_within = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const Patch patch(seed % 2 == 0 ? flat_grid(18, 3) : perforated_grid(18, 3));
    const ComplexVector random = random_map(patch.positions.rows() + 2, seed + 1);
    const double angle = 0.35 * (1 + random[0].real());
    ComplexVector z = mapped(patch, bent(angle, 1.5, 0.6 * (1 + random[0].imag())));
    const double noise = seed % 3 == 0 ? 0.0 : 0.25 * std::abs(random[1]);
    z += noise * random.tail(z.size());
    const bool found = overlaps(patch, z);
    const bool folded = folds(patch, z);
    CAPTURE(seed);
    // In doubt only where the boundary touches itself, which random numbers do not make it do.
    CHECK(certainly_injective(patch, z) == (!folded && !found));
    // Where the boundary leaves the flipped triangles to look at, they find all that the test of all pairs finds.
    const std::vector<bool> all_pairs = overlapping_triangles(patch.chart.triangles, z);
    std::vector<int> expected;
    for (std::size_t t = 0; t < all_pairs.size(); ++t) {
      if (all_pairs[t]) expected.push_back(static_cast<int>(t));
    }
    CHECK(overlapping_faces(patch.chart, z) == expected);
    injective += !folded && !found ? 1 : 0;
    unseen_by_flips += found && !folded ? 1 : 0;
    folded_within += folded && has_degree_at_most_one(patch.chart.boundary_loops, z) ? 1 : 0;
  }
  REQUIRE(injective > 50);
  REQUIRE(unseen_by_flips > 20);
  REQUIRE(folded_within > 20);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
