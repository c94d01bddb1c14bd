#include "parameterization/constrained_map.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "conformal/constrained_eigenproblem.h"
#include "geometry/signed_area.h"
#include "layout/placement.h"
#include "layout/upright.h"
#include "parameterization/attempts.h"
#include "parameterization/map_check.h"

namespace spectral_conformal {
namespace {

void place_without_turn(const SpectralProblem& problem, const LinearConstraints& constraints, ComplexVector& z) {
  const NormalizedPatch& patch = *problem.patch;
  // Of the two signs, both of which meet the constraints, the one that is upright.
  const Complex turn = upright_turn(z, problem.energy, patch.outer, patch.surface());
  const double area = problem.energy.area() * patch.scale * patch.scale;
  const double scale = std::copysign(std::sqrt(area / signed_area(problem.energy, z)), turn.real());
  const Complex mean = z.mean();
  const Complex origin(constraints.translation(0).size() > 0 ? mean.real() : 0.0,
                       constraints.translation(1).size() > 0 ? mean.imag() : 0.0);
  for (Complex& point : z) point = scale * (point - origin);
}

/// Numbers between -1 and 1, the same on every platform.
Eigen::VectorXd any_numbers(Eigen::Index n) {
  std::uint64_t state = 1;
  Eigen::VectorXd result(n);
  for (double& value : result) {
    // Knuth's MMIX generator.
    state = 6364136223846793005U * state + 1442695040888963407U;
    value = static_cast<double>(state >> 11) / 4503599627370496.0 - 1.0;
  }
  return result;
}

}  // namespace

Step contradiction(const NormalizedPatch& patch, const LinearEquations& equations) {
  // The area of a triangle of the map P w is a quadratic form of w. One that vanishes at any w vanishes at all
  // (Schwartz, Zippel).
  const LinearConstraints constraints(equations, static_cast<int>(patch.positions.rows()));
  const ComplexVector z = constraints.expanded(any_numbers(constraints.n_unknowns()));
  constexpr double rounding = 1e-11;
  const double size = z.size() > 0 ? z.array().abs().maxCoeff() : 0;
  Step flat;
  for (std::size_t t = 0; t + patch.n_virtual < patch.triangles.size(); ++t) {
    const auto& corners = patch.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      if (!(std::abs(z[b] - z[a]) > rounding * size)) return rejected(Rejection::constraints_join_vertices, a, b);
    }
    const auto& [a, b, c] = corners;
    if (flat.reason == Rejection::none && !(std::abs(signed_area(z[a], z[b], z[c])) > rounding * size * size)) {
      flat = rejected(Rejection::constraints_flatten_triangle, a, b, c);
    }
  }
  return flat;
}

Step with_vertices(Step contradiction, const std::vector<int>& vertices) {
  if (vertices.empty()) return contradiction;
  const auto renumber = [&](int& vertex) { vertex = vertices[static_cast<std::size_t>(vertex)]; };
  if (contradiction.reason == Rejection::constraints_join_vertices ||
      contradiction.reason == Rejection::constraints_flatten_triangle) {
    renumber(contradiction.count);
    renumber(contradiction.index);
    if (contradiction.reason == Rejection::constraints_flatten_triangle) renumber(contradiction.limit);
  }
  return contradiction;
}

SpectralMap constrained_map(const SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                            Timings& timings) {
  Stopwatch watch(timings);
  SpectralMap map;
  const LinearConstraints constraints(options.constraints, static_cast<int>(problem.patch->positions.rows()));
  watch.lap("constraints");
  const ConstrainedEigenpair found =
      solve_constrained_eigenproblem(problem.energy, problem.form, constraints, problem.patch->positions,
                                     first_attempt.relative_shift, problem.backend, progress);
  watch.lap("eigenproblem");
  map.solves = found.pair.solves;
  map.shift = found.shift;
  map.residual = found.pair.residual;
  map.rejection = !found.is_factored ? Rejection::not_factorized
                                     : (found.pair.converged ? Rejection::none : Rejection::not_converged);
  if (map.rejection != Rejection::none) return map;
  map.eigenvalue = eigenvalue_unit(problem, Method::spectral) / found.pair.mu;
  MapCheck check = measured_check(problem, found.pair.vector);
  check.eigenvalue = map.eigenvalue;
  check.error = found.change;
  check.error_limit = resolved_change;
  check.must_wind_once = true;
  map.turning_number = check.turning_number;
  map.rejection = check_map(found.pair.vector, check);
  if (map.rejection != Rejection::none) return map;
  map.z = found.pair.vector.head(problem.patch->n_vertices);
  place_without_turn(problem, constraints, map.z);
  watch.lap("placement");
  return map;
}

PatchMap constrained(const SolveTask& task, PatchMap map, const Progress& progress) {
  if (map.rejection || !task.is_constrained()) return map;
  map.take(constrained_map(task.patch.problem, task.options, progress, map.result.timings), task.options);
  return map;
}

}  // namespace spectral_conformal
