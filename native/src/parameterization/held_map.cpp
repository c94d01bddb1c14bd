#include "parameterization/held_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "conformal/held_extenders.h"
#include "conformal/lscm.h"
#include "conformal/pin_attraction.h"
#include "geometry/tolerances.h"
#include "mesh/boundary_loops.h"
#include "parameterization/map_check.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// The two farthest boundary vertices, at their distance in 3D (section 3.1).
Pins farthest_pins(const SpectralProblem& problem) {
  const NormalizedPatch& patch = *problem.patch;
  const auto pair = farthest_boundary_vertices(patch.outer, patch.positions, problem.energy.matrix());
  const double distance = (patch.positions.row(pair[1]) - patch.positions.row(pair[0])).norm();
  return {{pair[0], 0.0}, {pair[1], distance > 0 ? distance : 1.0}};
}

void hold(const Pins& pins, LinearEquations& equations) {
  for (const auto& [vertex, position] : pins) {
    equations.held.emplace_back(2 * vertex, position.real());
    equations.held.emplace_back(2 * vertex + 1, position.imag());
  }
}

HeldFrame frame_of(const SolveTask& task) {
  if (task.is_held()) return held_frame(task.options.constraints, task.held, task.attractors);
  HeldFrame result;
  hold(farthest_pins(task.patch.problem), result.equations);
  return result;
}

/// The equations, with one vertex held along each axis on which the map can still move.
LinearConstraints held_constraints(LinearEquations equations, int n_vertices) {
  LinearConstraints constraints = LinearConstraints::of(equations, n_vertices);
  bool is_free = false;
  for (const int axis : {0, 1}) {
    if (constraints.translation(axis).size() == 0) continue;
    equations.held.emplace_back(axis, 0.0);
    is_free = true;
  }
  return is_free ? LinearConstraints::of(equations, n_vertices) : constraints;
}

Springs springs_of(const SolveTask& task, const HeldFrame& frame) {
  if (task.attractors.empty()) return {};
  Springs result{task.attractors, task.options.soft_pins / static_cast<double>(task.attractors.size())};
  for (auto& [vertex, target] : result.targets) target = (target - frame.origin) / frame.unit;
  return result;
}

SpectralMap held_map(const SolveTask& task, const HeldFrame& frame, const Progress& progress, Timings& timings) {
  SpectralProblem& problem = task.patch.problem;
  const SolveOptions& options = task.options;
  Stopwatch watch(timings);
  SpectralMap map;
  map.solves = 1;
  Springs springs = springs_of(task, frame);
  const auto n_vertices = static_cast<int>(problem.patch->positions.rows());
  LinearConstraints constraints = springs.targets.empty() ? held_constraints(frame.equations, n_vertices)
                                                          : LinearConstraints::of(frame.equations, n_vertices);
  const ConformalEnergy& energy = problem.energy_under(options.constraints);
  watch.lap("constraints");
  std::unique_ptr<ReducedFactor>& factor = problem.restricted_factor;
  if (factor && factor->serves(constraints) && factor->springs().match(springs)) {
    factor->adopt(std::move(constraints), std::move(springs));
  } else {
    factor.reset();  // before the next one takes memory
    factor = std::make_unique<ReducedFactor>(ReducedFactor::of_held(
        energy, std::move(constraints), problem.patch->positions, problem.backend, progress, std::move(springs)));
    watch.lap("factorization");
  }
  map.shift = factor->shift();
  if (!factor->is_factored()) {
    factor.reset();
    map.rejection = Rejection::not_factorized;
    return map;
  }
  LscmSolution solution = solve_lscm(energy, *factor, progress, options.tolerance);
  const auto inverse = [&](const ComplexVector& force) {
    LscmSolution response = lscm_response(energy, force, *factor, progress, options.tolerance);
    ++map.solves;
    solution.change = std::max(solution.change, response.change);
    return std::move(response.vector);
  };
  const bool may_turn = factor->space().is_complex();
  if (options.has_extenders()) {
    push_and_pull(options.extenders, inverse, may_turn, factor->max_diagonal(), solution.vector);
    solution.energy = energy.value(solution.vector);
  }
  watch.lap("solve");
  map.residual = solution.residual;
  map.eigenvalue = solution.energy / problem.form.value(solution.vector) * eigenvalue_unit(problem, Method::lscm);
  MapCheck check = measured_check(problem, solution.vector);
  check.eigenvalue = map.eigenvalue;
  check.error = solution.change;
  check.error_limit = single_epsilon;
  check.may_be_mirrored = task.is_held();
  map.turning_number = check.turning_number;
  map.rejection = check_map(solution.vector, check);
  if (map.rejection == Rejection::none) map.whole = std::move(solution.vector);
  return map;
}

}  // namespace

HeldFrame held_frame(const LinearEquations& given, const Pins& pins, const Pins& attractors) {
  HeldFrame result{given};
  auto& held = result.equations.held;
  // Pins come first, as elsewhere.
  held.clear();
  hold(pins, result.equations);
  held.insert(held.end(), given.held.begin(), given.held.end());
  if (held.empty()) return result;
  double origin[2] = {0, 0};
  double count[2] = {0, 0};
  double first[2] = {0, 0};
  bool has_extent = false;  // rounding alone can give the smallest numbers a unit
  for (const auto& [coordinate, value] : held) {
    const int axis = coordinate % 2;
    if (count[axis]++ == 0) first[axis] = value;
    has_extent = has_extent || value != first[axis];
  }
  for (const auto& [coordinate, value] : held) origin[coordinate % 2] += value / count[coordinate % 2];
  for (const int axis : {0, 1}) {
    if (count[axis] > 0) continue;
    const auto n = static_cast<double>(attractors.size());
    for (const auto& [vertex, target] : attractors) origin[axis] += (axis == 0 ? target.real() : target.imag()) / n;
  }
  result.unit = 0;
  for (auto& [coordinate, value] : held) {
    value -= origin[coordinate % 2];
    result.unit = std::max(result.unit, std::abs(value));
  }
  if (!has_extent) {
    // Coordinates held at one position leave the size to the attractors.
    const Complex center(origin[0], origin[1]);
    for (const auto& [vertex, target] : attractors) {
      has_extent = has_extent || target != attractors.begin()->second;
      result.unit = std::max(result.unit, std::abs(target - center));
    }
  }
  if (!has_extent || !(result.unit > 0) || !std::isfinite(result.unit)) {
    throw InvalidMesh(Rejection::pins_at_one_position);
  }
  for (auto& [coordinate, value] : held) value /= result.unit;
  result.origin = {origin[0], origin[1]};
  return result;
}

PatchMap held(const SolveTask& task, PatchMap map, const Progress& progress) {
  map.set(held_map(task, frame_of(task), progress, map.result.timings), task.options);
  map.result.eigenvalue_of = EigenvalueOf::map;
  if (map.rejection) return map;
  const int unmet = task.patch.problem.restricted_factor->space().constraints().n_unmet();
  if (unmet > 0) map.add(counted(StepKind::unmet_constraints, unmet));
  return map;
}

void place_held(const SolveTask& task, ComplexVector& z) {
  const HeldFrame frame = held_frame(task.options.constraints, task.held, task.attractors);
  for (Complex& point : z) point = frame.origin + frame.unit * point;
  // Backward: of several values of a coordinate, the first one holds.
  const auto& held = task.options.constraints.held;
  for (auto each = held.rbegin(); each != held.rend(); ++each) {
    Complex& point = z[each->first / 2];
    point = each->first % 2 == 0 ? Complex(each->second, point.imag()) : Complex(point.real(), each->second);
  }
  for (const auto& [vertex, position] : task.held) z[vertex] = position;
}

PatchMap fitted_to_pins(const SolveTask& task, PatchMap map) {
  const Pins& pins = task.pins;
  ComplexVector& z = map.result.z;
  if (task.is_pinned()) {
    const auto& [vertex, position] = *pins.begin();
    z.array() += position - z[vertex];
    z[vertex] = position;
  } else if (!fit_to_pins(z, pins, !task.is_constrained())) {
    throw InvalidMesh(Rejection::pins_at_one_position);
  } else if (task.attractors.empty()) {
    // A similarity meets two pins up to rounding, a translation one.
    for (const auto& [vertex, position] : pins) z[vertex] = position;
  }
  return map;
}

}  // namespace spectral_conformal
