#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "meshes.h"
#include "relaxation/boundary_barrier.h"

namespace spectral_conformal::test {
namespace {

const std::vector<BoundaryLoop> loops{{0, 1, 2, 3, 4, 5, 6, 7}};

/// A square of side 2, each side of two edges: vertex 1 in the middle of the lower side, 5 of the upper one.
ComplexVector square() {
  ComplexVector z(8);
  z << Complex(0, 0), Complex(1, 0), Complex(2, 0), Complex(2, 1), Complex(2, 2), Complex(1, 2), Complex(0, 2),
      Complex(0, 1);
  return z;
}

/// Vertex 1 somewhere else.
ComplexVector with_first_at(Complex place) {
  ComplexVector z = square();
  z[1] = place;
  return z;
}

struct Value {
  double energy;
  ComplexVector gradient;
};

Value at(const BoundaryBarrier& barrier, const ComplexVector& z) {
  Value value{0, ComplexVector::Zero(z.size())};
  value.energy = barrier.add(barrier.pairs_near(z, ComplexVector::Zero(z.size())), z, value.gradient);
  return value;
}

double max_step(const BoundaryBarrier& barrier, const ComplexVector& z, const ComplexVector& step) {
  return BoundaryBarrier::max_step(barrier.pairs_near(z, step), z, step);
}

ComplexVector only_first(Complex step) {
  ComplexVector steps = ComplexVector::Zero(8);
  steps[1] = step;
  return steps;
}

}  // namespace

TEST_SUITE_BEGIN("boundary_barrier");

TEST_CASE("a boundary that is nowhere near itself has no energy") {
  const Value value = at(BoundaryBarrier::around(loops, square()), square());
  CHECK(value.energy == 0);
  CHECK(value.gradient.isZero(0));
}

TEST_CASE("the edges at a vertex through which the boundary passes very often count no more") {
  // Triangles about one vertex, which share no edge, and a square far away.
  const int n = 100;
  std::vector<BoundaryLoop> star;
  ComplexVector z = ComplexVector::Zero(2 * n + 1);
  for (int k = 0; k < n; ++k) {
    star.push_back({0, 2 * k + 1, 2 * k + 2});
    for (int i = 1; i <= 2; ++i) z[2 * k + i] = std::polar(1.0, pi * (2 * k + i) / n);
  }
  const ComplexVector growth = 0.3 * (z.real().cast<Complex>() - 0.5 * z);
  const auto ignored = BoundaryBarrier::around(star, z, BoundaryBarrier::Contacts::ignored);
  CHECK(ignored.ignores_contacts());
  const auto has_hub = [](const BoundaryBarrier::Pair& pair) { return pair.from == 0 || pair.to == 0; };
  const std::vector<BoundaryBarrier::Pair> pairs = ignored.pairs_near(z, growth);
  CHECK(std::none_of(pairs.begin(), pairs.end(), has_hub));
  star.resize(50);
  const auto few = BoundaryBarrier::around(star, z, BoundaryBarrier::Contacts::ignored);
  CHECK_FALSE(few.ignores_contacts());
  const std::vector<BoundaryBarrier::Pair> few_pairs = few.pairs_near(z, growth);
  CHECK(std::count_if(few_pairs.begin(), few_pairs.end(), has_hub) > 100);
}

TEST_CASE("the energy is that of the distance to the edge, and infinite at contact") {
  const BoundaryBarrier barrier = BoundaryBarrier::around(loops, square());
  // 0.1 below the edge from (2, 2) to (1, 2); D is 0.25.
  CHECK(at(barrier, with_first_at({1.5, 1.9})).energy == doctest::Approx(1e-4 / 8 * 1.5 * 1.5));
  CHECK(at(barrier, with_first_at({1.5, 1.9})).gradient[1].imag() > 0);
  CHECK(std::isinf(at(barrier, with_first_at({1.5, 2})).energy));
  CHECK(at(barrier, with_first_at({1.5, 1.7})).energy == 0);
}

TEST_CASE("the reach ends at what is nearest in the initial map, which has no energy, however thin") {
  // Two quads of length 1 and width 0.01.
  const std::vector<BoundaryLoop> around{{0, 1, 2, 3, 4, 5}};
  ComplexVector z(6);
  z << Complex(0, 0), Complex(1, 0), Complex(2, 0), Complex(2, 0.01), Complex(1, 0.01), Complex(0, 0.01);
  const BoundaryBarrier barrier = BoundaryBarrier::around(around, z, BoundaryBarrier::Contacts::ignored);
  CHECK_FALSE(barrier.ignores_contacts());
  CHECK(at(barrier, z).energy < 1e-30);
  ComplexVector thinner = z;
  thinner[4] = {1, 0.005};
  // From the vertex to the edges below on both sides of the other one, and back.
  CHECK(at(barrier, thinner).energy > 1e-4 / 6);
  // Where contacts count, the initial map is no measure.
  CHECK(at(BoundaryBarrier::around(around, z), z).energy > 1e-4);
}

TEST_CASE("a long step across many edges is shortened until few pairs are near it") {
  // Two rows of teeth, whose swap would take every tooth past every other one.
  constexpr int n = 1000;
  BoundaryLoop loop;
  ComplexVector z(2 * n);
  for (int k = 0; k < 2 * n; ++k) {
    loop.push_back(k);
    const double x = k < n ? k : 2 * n - 1 - k;
    z[k] = Complex(x, (k < n ? 0 : 3) + k % 2);
  }
  const BoundaryBarrier barrier = BoundaryBarrier::around({loop}, z);
  const ComplexVector step = -2 * z;
  const BoundaryBarrier::Way way = barrier.way_along(z, step);
  CHECK(way.part < 1);
  CHECK(way.part > 1e-3);
  CHECK(way.pairs.size() <= 128000);
  CHECK(way.pairs.size() == barrier.pairs_near(z, way.part * step).size());
  CHECK(barrier.way_along(z, 1e-3 * step).part == 1);
}

TEST_CASE("a step that only turns and scales the map brings no pairs near each other, however many edges it has") {
  constexpr int n = 4000;
  BoundaryLoop loop;
  ComplexVector z(n);
  for (int k = 0; k < n; ++k) {
    loop.push_back(k);
    z[k] = std::polar(k % 2 == 0 ? 1.0 : 0.999, 2 * pi * k / n);
  }
  const BoundaryBarrier barrier = BoundaryBarrier::around({loop}, z);
  const ComplexVector step = Complex(0.5, 1) * z;
  CHECK(barrier.pairs_near(z, step).size() < 8 * n);
  CHECK(barrier.way_along(z, step).part == 1);
}

TEST_CASE("thin spikes, in whose boxes the vertices of many others lie, keep their reach and are near few pairs") {
  constexpr int n = 1000;
  const ComplexVector random = random_map(n, 2);
  BoundaryLoop loop;
  ComplexVector z(n);
  for (int k = 0; k < n; ++k) {
    loop.push_back(k);
    z[k] = std::polar(k % 2 == 0 ? 0.55 + 0.2 * random[k].real() : 1.0, 2 * pi * k / n);
  }
  const BoundaryBarrier barrier = BoundaryBarrier::around({loop}, z, BoundaryBarrier::Contacts::ignored);
  CHECK_FALSE(barrier.ignores_contacts());
  CHECK(barrier.pairs_near(z, ComplexVector::Zero(n)).size() < 8 * n);
  ComplexVector nearer = z;
  nearer[501] += 0.9 * (z[502] - z[501]) * Complex(0, 1) * std::abs(z[503] - z[501]);
  CHECK(at(barrier, z).energy < 1e-12);
  CHECK(at(barrier, nearer).energy > 1e-8);
}

TEST_CASE("ignored contacts have no energy, all others do") {
  const ComplexVector touching = with_first_at({1.5, 2});
  const BoundaryBarrier barrier = BoundaryBarrier::around(loops, touching, BoundaryBarrier::Contacts::ignored);
  CHECK(barrier.ignores_contacts());
  CHECK(std::isfinite(at(barrier, touching).energy));
  ComplexVector elsewhere = square();
  elsewhere[5] = {1, 0.1};
  CHECK(at(barrier, elsewhere).energy > 0);
  CHECK_FALSE(BoundaryBarrier::around(loops, square(), BoundaryBarrier::Contacts::ignored).ignores_contacts());
}

TEST_CASE("the gradient is that of finite differences, and the curvature bounds the second ones") {
  const BoundaryBarrier barrier = BoundaryBarrier::around(loops, square());
  // Beside an edge, and beside the vertex between two.
  for (const Complex place : {Complex(1.4, 1.85), Complex(1.03, 1.9), Complex(1.99, 1.2)}) {
    const ComplexVector z = with_first_at(place) + 0.01 * random_map(8, 3);
    const Value value = at(barrier, z);
    REQUIRE(value.energy > 0);
    Eigen::VectorXd curvature = Eigen::VectorXd::Zero(8);
    barrier.add_curvature(barrier.pairs_near(z, ComplexVector::Zero(8)), z, curvature);
    for (unsigned seed = 1; seed < 20; ++seed) {
      constexpr double h = 1e-5;
      const ComplexVector direction = random_map(8, seed);
      const double forward = at(barrier, z + h * direction).energy;
      const double backward = at(barrier, z - h * direction).energy;
      double slope = 0;
      double bound = 0;
      for (int v = 0; v < 8; ++v) {
        slope += std::real(std::conj(direction[v]) * value.gradient[v]);
        bound += curvature[v] * std::norm(direction[v]);
      }
      CHECK((forward - backward) / (2 * h) == doctest::Approx(slope).epsilon(1e-5));
      CHECK((forward - 2 * value.energy + backward) / (h * h) <= bound * (1 + 1e-4));
    }
  }
}

TEST_CASE("a step is told when the boundary first touches itself, at an edge, at a vertex, and between moving ones") {
  const BoundaryBarrier barrier = BoundaryBarrier::around(loops, square());
  CHECK(max_step(barrier, with_first_at({1.5, 0}), only_first({0, 4})) == doctest::Approx(0.5));
  CHECK(max_step(barrier, square(), only_first({0, 4})) == doctest::Approx(0.5));
  CHECK(std::isinf(max_step(barrier, square(), only_first({0, 1.9}))));
  ComplexVector toward_each_other = only_first({0, 2});
  toward_each_other[4] = toward_each_other[5] = Complex(0, -2);
  CHECK(max_step(barrier, with_first_at({1.5, 0}), toward_each_other) == doctest::Approx(0.5));
}

TEST_CASE("a whole that moves, turns or grows does not touch itself") {
  const BoundaryBarrier barrier = BoundaryBarrier::around(loops, square());
  const ComplexVector z = with_first_at({1.5, 1.9});
  for (const Complex factor : {Complex(0, 0), Complex(1, 0), Complex(-0.5, 0.5)}) {
    CHECK(std::isinf(max_step(barrier, z, factor * z + ComplexVector::Constant(8, Complex(3, 1)))));
  }
}

TEST_CASE("loops meet each other, too") {
  ComplexVector z(12);
  z << square(), Complex(0.9, 0.9), Complex(0.9, 1.1), Complex(1.1, 1.1), Complex(1.1, 0.9);
  std::vector<BoundaryLoop> with_hole = loops;
  with_hole.push_back({8, 9, 10, 11});
  const BoundaryBarrier barrier = BoundaryBarrier::around(with_hole, z);
  ComplexVector step = ComplexVector::Zero(12);
  step.tail(4).setConstant(Complex(2, 0));
  CHECK(max_step(barrier, z, step) == doctest::Approx(0.45));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
