#include "parameterization/constrained_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "conformal/nearest_map.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "graph/mixed_bits.h"
#include "layout/placement.h"
#include "layout/upright.h"
#include "parameterization/attempts.h"
#include "parameterization/held_map.h"
#include "parameterization/map_check.h"

namespace spectral_conformal {
namespace {

Eigen::VectorXd any_numbers(Eigen::Index n) {
  Eigen::VectorXd result(n);
  for (Eigen::Index k = 0; k < n; ++k) result[k] = pseudo_random(static_cast<std::uint64_t>(k) + 1);
  return result;
}

}  // namespace

MapCheck with_folds(const NormalizedPatch& patch, const ComplexVector& z, MapCheck check) {
  check.max_folded = 0.1;
  double area = 0;
  for (std::size_t t = 0; t + patch.n_virtual < patch.triangles.size(); ++t) {
    const auto& [a, b, c] = patch.triangles[t];
    const double own = patch.triangle_weights[t] * signed_area(z[a], z[b], z[c]);
    area += std::abs(own);
    if (own < 0) {
      ++check.flipped;
      check.folded -= own;
    }
  }
  if (check.flipped > 0) check.folded /= area;
  poll(patch.triangles.size());
  return check;
}

Step contradiction(const NormalizedPatch& patch, const LinearEquations& equations, const Pins& held,
                   const Pins& attractors) {
  // The area of a triangle of the map P w is a quadratic form of w. One that vanishes at any w vanishes at all
  // (Schwartz, Zippel).
  const HeldFrame frame = held_frame(equations, held, attractors);
  const LinearConstraints constraints =
      LinearConstraints::of(frame.equations, static_cast<int>(patch.positions.rows()));
  const ComplexVector z = constraints.expanded(any_numbers(constraints.n_unknowns())) + constraints.offset();
  const int* const rows = constraints.expansion().outerIndexPtr();
  // Held vertices may coincide. If nothing is held, vertices without unknowns lie at the origin.
  const bool has_held = !frame.equations.held.empty();
  const auto is_held = [&](int vertex) { return has_held && rows[2 * vertex] == rows[2 * vertex + 2]; };
  const double size = z.size() > 0 ? std::sqrt(z.array().abs2().maxCoeff()) : 0;
  const std::size_t n = patch.triangles.size() - patch.n_virtual;
  for (std::size_t t = 0; t < n; ++t) {
    const auto& corners = patch.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      if (is_held(a) && is_held(b)) continue;
      if (!(std::norm(z[b] - z[a]) > sum_rounding * sum_rounding * size * size))
        return rejected(Rejection::constraints_join_vertices, a, b);
    }
  }
  const auto is_flat = [&](std::size_t t) {
    const auto& [a, b, c] = patch.triangles[t];
    if (is_held(a) && is_held(b) && is_held(c)) return false;
    return !(std::abs(signed_area(z[a], z[b], z[c])) > sum_rounding * size * size);
  };
  const auto first_flat = [&](std::size_t begin, std::size_t end) {
    while (begin < end && !is_flat(begin)) ++begin;
    return begin;
  };
  for (std::size_t t = 0; t < n;) {
    const bool is_quad = patch.triangle_weights[t].in_both_splits();
    const std::size_t end = t + (is_quad ? 2 : 1);
    const std::size_t flat = first_flat(t, end);
    // Of a mapped quad the better split counts (quad_splits.h), so three of its corners may lie on a mirror axis.
    if (flat < end && !(is_quad && first_flat(end, end + 2) == end + 2)) {
      const auto& [a, b, c] = patch.triangles[flat];
      return rejected(Rejection::constraints_flatten_triangle, a, b, c);
    }
    t = is_quad ? end + 2 : end;
  }
  return {};
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

PatchMap nearest_to_free(const SolveTask& task, PatchMap map, const Progress& progress) {
  SpectralProblem& problem = task.patch.problem;
  const NormalizedPatch& patch = *problem.patch;
  const auto flipped = [&](const SpectralMap& of) { return n_flipped(patch, of.whole.head(patch.n_vertices)); };
  const bool is_misshapen = map.found.is_misshapen();
  const int flipped_before = map.rejection ? 0 : flipped(map.found);
  if (!is_misshapen && flipped_before == 0) return map;
  Timings& timings = map.result.timings;
  SolveOptions free = task.options;
  free.constraints = {};
  free.hole_rigidity = map.result.hole_rigidity;
  // The other factorization would drop it.
  std::unique_ptr<ReducedFactor> factor = std::move(problem.restricted_factor);
  const SpectralMap target = attempted_map(problem, free, {}, progress, timings);
  problem.restricted_factor = std::move(factor);
  if (target.rejection != Rejection::none) return map;
  Stopwatch watch(timings);
  SpectralMap nearest;
  nearest.whole = nearest_map(
      problem.energy, LinearConstraints::of(task.options.constraints, static_cast<int>(patch.positions.rows())),
      problem.form, patch.positions, first_attempt.relative_shift, target.whole, problem.backend, progress);
  watch.lap("nearest map");
  if (nearest.whole.size() == 0) return map;
  MapCheck check = with_folds(patch, nearest.whole, measured_check(problem, nearest.whole));
  check.must_wind_once = true;
  const MapNumbers numbers = map_numbers(problem, nearest.whole);
  check.eigenvalue = numbers.eigenvalue;
  check.error_limit = single_epsilon;
  if (check_map(nearest.whole, check) != Rejection::none || (!is_misshapen && flipped(nearest) >= flipped_before)) {
    return map;
  }
  nearest.eigenvalue = numbers.eigenvalue;
  nearest.residual = numbers.residual;
  nearest.turning_number = numbers.turning_number;
  nearest.solves = map.found.solves + target.solves;
  const int turns = map.found.rejection == Rejection::winding ? map.found.turning_number : 1;
  map.set(std::move(nearest), task.options);
  map.result.attempts = 2;
  map.result.eigenvalue_of = EigenvalueOf::map;
  map.add(counted(StepKind::nearest_to_free, turns));
  return map;
}

void place_constrained(const SolveTask& task, ComplexVector& z) {
  const SpectralProblem& problem = task.patch.problem;
  const LinearConstraints& constraints = problem.restricted_factor->space().constraints();
  const NormalizedPatch& patch = *problem.patch;
  // Both signs meet the constraints. Take the upright one or, if the map lies on its side, the one whose up points
  // right.
  const Complex turn = upright_turn(z, problem.energy, patch.outer, patch.surface());
  const double upright = std::abs(turn.real()) > insignificant ? turn.real() : turn.imag();
  const double area = problem.energy.area() * patch.scale * patch.scale;
  const double scale = std::copysign(std::sqrt(area / signed_area(problem.energy, z)), upright);
  const Complex mean = z.mean();
  const Complex origin(constraints.translation(0).size() > 0 ? mean.real() : 0.0,
                       constraints.translation(1).size() > 0 ? mean.imag() : 0.0);
  for (Complex& point : z) point = scale * (point - origin);
}

}  // namespace spectral_conformal
