#include <doctest/doctest.h>

#include <cmath>

#include "spectral_conformal/linear_constraints.h"

namespace spectral_conformal::test {
namespace {

LinearEquations equations_of(const std::vector<std::vector<std::pair<int, double>>>& all) {
  LinearEquations result;
  for (const auto& terms : all) result.add(terms);
  return result;
}

}  // namespace

TEST_SUITE("linear_constraints") {
  // u_0 = -u_1 about a mirror axis, on which vertex 2 lies; v_0 = v_1.
  const LinearEquations mirrored = equations_of({{{0, 1}, {2, 1}}, {{1, 1}, {3, -1}}, {{4, 1}}});

  TEST_CASE("P and its transpose") {
    const LinearConstraints constraints = LinearConstraints::of(mirrored, 3);
    REQUIRE(constraints.coordinates() == std::vector<int>{0, 1, 5});
    const Eigen::Vector3d w(2, 3, 5);
    const ComplexVector z = constraints.expanded(w);
    CHECK(z[0] == Complex(2, 3));
    CHECK(z[1] == Complex(-2, 3));
    CHECK(z[2] == Complex(0, 5));
    // w^T P^T x = (P w)^T x
    ComplexVector x(3);
    x << Complex(1, 7), Complex(4, -2), Complex(9, 6);
    CHECK(w.dot(constraints.gathered(x)) == doctest::Approx(z.real().dot(x.real()) + z.imag().dot(x.imag())));
  }

  TEST_CASE("a mirror axis allows no translation across it") {
    const LinearConstraints constraints = LinearConstraints::of(mirrored, 3);
    CHECK(constraints.translation(0).size() == 0);
    CHECK(constraints.translation(1) == Eigen::Vector3d(0, 1, 1));
    CHECK(LinearConstraints::of(equations_of({{{0, 1}, {2, -1}}}), 2).translation(0) == Eigen::Vector3d(1, 0, 0));
  }

  TEST_CASE("held coordinates: the axis goes where they have it, and contradictions are left out") {
    LinearEquations equations = mirrored;
    equations.held = {{0, 1.0}, {2, 3.0}, {1, 0.25}};
    const LinearConstraints constraints = LinearConstraints::of(equations, 3);
    CHECK(constraints.n_unknowns() == 1);
    const ComplexVector z = constraints.expanded(Eigen::VectorXd::Constant(1, 7)) + constraints.offset();
    CHECK(z[0] == Complex(1, 0.25));
    CHECK(z[1] == Complex(3, 0.25));
    CHECK(z[2] == Complex(2, 7));
    CHECK(constraints.n_unmet() == 0);
    equations.held.emplace_back(3, 0.5);
    CHECK(LinearConstraints::of(equations, 3).n_unmet() == 1);
    equations.held.back().second = 0.25 + 1e-6;
    CHECK(LinearConstraints::of(equations, 3).n_unmet() == 0);
  }

  TEST_CASE("an order of equations, their scale and their repetition change nothing") {
    // A chain of one v, given backward, twice and in other units.
    LinearEquations chain;
    for (int v = 98; v >= 0; --v) chain.add({{2 * v + 1, 1e-5}, {2 * v + 3, -1e-5}});
    for (int v = 0; v < 99; ++v) chain.add({{2 * v + 1, 3e4}, {2 * v + 3, -3e4}});
    const LinearConstraints constraints = LinearConstraints::of(chain, 100);
    CHECK(constraints.n_unknowns() == 101);
    const ComplexVector z = constraints.expanded(Eigen::VectorXd::LinSpaced(101, 1, 2));
    for (int v = 1; v < 100; ++v) CHECK(z[v].imag() == z[0].imag());
  }

  TEST_CASE("a line at an angle, and even steps on it") {
    const double angle = 0.3;
    LinearEquations line;
    for (int v = 0; v < 4; ++v) {
      const double u = -std::sin(angle);
      line.add({{2 * v, u}, {2 * v + 2, -u}, {2 * v + 1, std::cos(angle)}, {2 * v + 3, -std::cos(angle)}});
    }
    for (int v = 0; v < 3; ++v) line.add({{2 * v, 1}, {2 * v + 2, -2}, {2 * v + 4, 1}});
    const LinearConstraints constraints = LinearConstraints::of(line, 5);
    REQUIRE(constraints.n_unknowns() == 3);
    const ComplexVector z = constraints.expanded(Eigen::Vector3d(0.2, -0.7, 1.9));
    for (int v = 1; v < 5; ++v) {
      const Complex step = (z[v] - z[v - 1]) * std::polar(1.0, -angle);
      CHECK(std::abs(step.imag()) < 1e-14);
      CHECK(step.real() == doctest::Approx(((z[1] - z[0]) * std::polar(1.0, -angle)).real()).epsilon(1e-13));
    }
  }

  TEST_CASE("only equations whose vertices all have a number") {
    const LinearEquations part = mirrored.renumbered({-1, 1, 0});
    CHECK(part.start == std::vector<int>{0, 1});
    CHECK(part.coordinate == std::vector<int>{0});
  }

  TEST_CASE("by part: equations between parts, or of vertices of none, are left out") {
    LinearEquations equations;
    equations.add({{0, 1}, {5, -1}});
    equations.add({{0, 1}, {2, -1}});
    equations.add({{3, 2}, {5, -2}});
    equations.add({{7, 1}});
    equations.held = {{1, 0.5}, {4, 0.25}, {6, 1}};
    const std::vector<LinearEquations> parts = equations.by_part({0, 1, 1, -1}, {3, 1, 0, -1}, 2);
    REQUIRE(parts.size() == 2);
    CHECK(parts[0].size() == 0);
    CHECK(parts[0].held == std::vector<std::pair<int, double>>{{7, 0.5}});
    CHECK(parts[1].start == std::vector<int>{0, 2});
    CHECK(parts[1].coordinate == std::vector<int>{3, 1});
    CHECK(parts[1].coefficient == std::vector<double>{2, -2});
    CHECK(parts[1].held == std::vector<std::pair<int, double>>{{0, 0.25}});
  }
}

}  // namespace spectral_conformal::test
