#include <doctest/doctest.h>

#include <cmath>

#include "parameterization/spectral_map.h"
#include "parameterization/spectral_problem.h"
#include "problems.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("spectral_problem");

TEST_CASE("another metric, another form of the factor or clamped triangles take the factor away") {
  const Patch patch(flat_grid(6, 5));
  SpectralProblem problem = problem_of(patch);
  problem.factorize(Method::spectral, 1e-12, {});
  CHECK(problem.is_factored());
  const Factorization* const kept = &problem.factor.factorization();
  problem.factorize(Method::area, 1e-12, {});
  CHECK(&problem.factor.factorization() == kept);
  const double shift = problem.factor.shift();
  problem.factorize(Method::fiedler, 1e-12, {});
  CHECK(problem.factor.shift() != shift);
  CHECK(problem.clamp(1e-5) == 0);
  CHECK_FALSE(problem.is_factored());
  problem.factorize(Method::spectral, 1e-12, {});
  std::vector<TriangleMetric> metric(patch.chart.triangles.size());
  for (TriangleMetric& g : metric) g = {2, 0.5, 1};
  problem.stretch(metric);
  CHECK_FALSE(problem.is_factored());
  const SpectralProblem other = other_problem(problem, Weights::inverse_area, BoundaryMeasure::vertex);
  CHECK(other.energy.weights() == Weights::inverse_area);
  CHECK(other.boundary == BoundaryMeasure::vertex);
  CHECK(other.energy.energy_shapes()[3].x1 == problem.energy.energy_shapes()[3].x1);
}

TEST_CASE("the numbers of a map do not depend on a factor") {
  SpectralProblem problem = problem_of(Patch(bumpy_grid(5, 4)));
  const ComplexVector map = random_map(problem.patch->n_vertices);
  const double without = map_numbers(problem, map).residual;
  CHECK((std::isfinite(without) && without > 0));
  problem.factorize(Method::spectral, 1e-12, {});
  CHECK(map_numbers(problem, map).residual == without);
}

TEST_CASE("a map without positive area is not placed") {
  SpectralProblem problem = problem_of(Patch(flat_grid(4, 3)));
  Timings timings;
  const ComplexVector mirrored = attempted_map(problem, {}, {}, {}, timings).whole.conjugate();
  ComplexVector z = mirrored;
  CHECK_FALSE(place(problem, z));
  CHECK(z == mirrored);
}

TEST_CASE("the form acts on the boundary, rigid holes, everything for Fiedler, or is the area") {
  const SpectralProblem problem = problem_of(Patch(perforated_grid(7, 7)));
  const std::size_t n_boundary = problem.form.vertices.size();
  CHECK(quotient_form(problem, {}, {}).support() == problem.form.vertices);
  SolveOptions options;
  options.hole_rigidity = 2;
  CHECK(quotient_form(problem, options, {}).support().size() > n_boundary);
  options = {};
  options.method = Method::fiedler;
  CHECK(static_cast<int>(quotient_form(problem, options, {}).support().size()) == problem.patch->n_vertices);
  options.method = Method::area;
  const ComplexVector z = random_map(problem.patch->n_vertices);
  CHECK(quotient_form(problem, options, {}).value_of_map(z) == doctest::Approx(problem.energy.area_form(z)));
}

TEST_CASE("a check measures area and turning number of finite maps only") {
  const Patch patch(flat_grid(4, 3));
  const SpectralProblem problem = problem_of(patch);
  ComplexVector z = flat_map(problem.patch->positions);
  CHECK(measured_check(problem, z).turning_number == 1);
  CHECK(measured_check(problem, z).area > 0);
  z[2] = std::nan("");
  CHECK(measured_check(problem, z).area == 0);
}

TEST_CASE("an outer loop without length is refused") {
  const Patch patch(bumpy_grid(3, 3));
  NormalizedPatch point = normalized_patch(patch.chart, patch.positions, false);
  for (const int v : point.outer) point.positions.row(v).setZero();
  CHECK_THROWS_AS(problem_of(point), InvalidMesh);
  // By vertex it has a form, from which none by length can be made.
  const SpectralProblem by_vertex = problem_of(point, BoundaryMeasure::vertex);
  CHECK_THROWS_AS(other_problem(by_vertex, Weights::uniform, BoundaryMeasure::length), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
