#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include "meshes.h"
#include "parameterization/constrained_map.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

/// One u for the vertices of a patch.
LinearEquations one_u(const std::vector<int>& column) {
  LinearEquations result;
  for (std::size_t k = 1; k < column.size(); ++k) result.add({{2 * column[k - 1], 1}, {2 * column[k], -1}});
  return result;
}

}  // namespace

TEST_SUITE("constrained_map") {
  TEST_CASE("it has the area in 3D and its mean at the origin, and is not turned; polished, it keeps the constraints") {
    const Patch patch(bumpy_grid(12, 7));
    SolveOptions options;
    options.constraints = one_u({0, 1, 2, 3});
    options.fold_free = true;
    Solver solver = Solver::of(patch.chart, patch.positions, {});
    const Parameterization map = solver.solve(options, {});
    for (const int v : {1, 2, 3}) CHECK(map.z[v].real() == map.z[0].real());
    CHECK(std::abs(map.z.mean()) < 1e-12);
    CHECK(shoelace_area(patch.outer(), map.z) == doctest::Approx(solver.energy().area() * std::pow(solver.scale(), 2)));
    CHECK(map.polish_steps == 0);
    CHECK(map.eigenvalue_of == EigenvalueOf::eigenvector);
    CHECK(map.eigenvalue > solver.solve({}, {}).eigenvalue);
    options.polish = Polish::angles;
    const Parameterization polished = solver.solve(options, {});
    CHECK((polished.polish_steps > 0 && polished.eigenvalue_of == EigenvalueOf::map));
    for (const int v : {1, 2, 3}) CHECK(polished.z[v].real() == doctest::Approx(polished.z[0].real()).epsilon(1e-13));
    options.polish = Polish::off;
    // A pin moves it; two hold it.
    const Parameterization moved = solver.solve(options, {{5, Complex(2, 3)}});
    CHECK(moved.z[5] == Complex(2, 3));
    CHECK((moved.z.array() - moved.z.mean() - map.z.array()).abs().maxCoeff() < 1e-12);
    const Parameterization held = solver.solve(options, {{5, Complex(2, 3)}, {60, Complex(9, 9)}});
    CHECK((held.z[5] == Complex(2, 3) && held.z[60] == Complex(9, 9) && held.method == Method::lscm));
    for (const int v : {1, 2, 3}) CHECK(held.z[v].real() == doctest::Approx(held.z[0].real()).epsilon(1e-13));
  }

  TEST_CASE("what contradicts itself is named by its vertices") {
    const Patch patch(bumpy_grid(6, 4));
    const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
    const auto& [a, b, c] = normalized.triangles[5];
    CHECK(contradiction(normalized, one_u({a, b})).reason == Rejection::none);
    const Step flat = contradiction(normalized, one_u({a, b, c}));
    CHECK(flat.reason == Rejection::constraints_flatten_triangle);
    CHECK(std::set<int>{flat.count, flat.index, flat.limit} == std::set<int>{a, b, c});
    LinearEquations joined = one_u({a, b});
    joined.add({{2 * a + 1, 1}, {2 * b + 1, -1}});
    const Step step = contradiction(normalized, joined);
    CHECK(step.reason == Rejection::constraints_join_vertices);
    CHECK(std::set<int>{step.count, step.index} == std::set<int>{a, b});
    std::vector<int> others(static_cast<std::size_t>(normalized.n_vertices));
    std::iota(others.begin(), others.end(), 100);
    CHECK(with_vertices(step, others).count == step.count + 100);
    CHECK(with_vertices(flat, others).limit == flat.limit + 100);
  }

  TEST_CASE("of a quad the better split counts: three corners may lie on one line, four may not") {
    const Patch patch(quad_grid(2, 2));
    const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
    REQUIRE(normalized.triangle_weights[0].in_both_splits());
    const auto& [a, b, c] = normalized.triangles[0];
    const int d = normalized.triangles[1][2];
    CHECK(contradiction(normalized, one_u({a, b, c})).reason == Rejection::none);
    CHECK(contradiction(normalized, one_u({b, c, d})).reason == Rejection::none);
    CHECK(contradiction(normalized, one_u({a, b, c, d})).reason == Rejection::constraints_flatten_triangle);
  }
}

}  // namespace spectral_conformal::test
