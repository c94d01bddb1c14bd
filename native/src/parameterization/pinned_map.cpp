#include "parameterization/pinned_map.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "conformal/correction.h"
#include "conformal/held_extenders.h"
#include "conformal/lscm.h"
#include "conformal/pin_attraction.h"
#include "geometry/tolerances.h"
#include "mesh/boundary_loops.h"
#include "parameterization/map_check.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

InvalidMesh same_position() { return InvalidMesh(Rejection::pins_at_one_position); }

/// Pins in their own unit, so that the solve does not depend on their magnitude: z = origin + unit * held.
struct ScaledPins {
  Pins held;
  Complex origin = 0;
  double unit = 0;
};

ScaledPins scaled(const Pins& pins) {
  ScaledPins result;
  for (const auto& pin : pins) result.origin += pin.second / static_cast<double>(pins.size());
  for (const auto& pin : pins) {
    const Complex offset = pin.second - result.origin;
    result.unit = std::max({result.unit, std::abs(offset.real()), std::abs(offset.imag())});
  }
  // Rounding alone can give the smallest numbers an extent.
  const bool equal =
      std::all_of(pins.begin(), pins.end(), [&pins](const auto& pin) { return pin.second == pins.begin()->second; });
  if (equal || !(result.unit > 0) || !std::isfinite(result.unit)) throw same_position();
  for (const auto& [vertex, position] : pins) result.held[vertex] = (position - result.origin) / result.unit;
  return result;
}

/// The two farthest boundary vertices, at their distance in 3D (section 3.1).
Pins farthest_pins(const SpectralProblem& problem) {
  const NormalizedPatch& patch = *problem.patch;
  const auto pair = farthest_boundary_vertices(patch.outer, patch.positions, problem.energy.matrix());
  const double distance = (patch.positions.row(pair[1]) - patch.positions.row(pair[0])).norm();
  return {{pair[0], 0.0}, {pair[1], distance > 0 ? distance : 1.0}};
}

}  // namespace

SpectralMap pinned_map(SpectralProblem& problem, const Pins& pins, const std::vector<Extender>& extenders,
                       double tolerance, const Progress& progress, Timings& timings) {
  Stopwatch watch(timings);
  const ConformalEnergy& energy = problem.energy;
  const bool hold = pins.size() >= 2;
  const ScaledPins scaled_pins = hold ? scaled(pins) : ScaledPins{farthest_pins(problem), 0, 1};
  SpectralMap map;
  map.solves = 1;
  std::unique_ptr<PinnedFactor>& factor = problem.pinned_factor;
  if (!factor || !factor->holds(scaled_pins.held)) {
    factor.reset();  // before the next one takes memory
    factor = std::make_unique<PinnedFactor>(PinnedFactor::of(energy, scaled_pins.held, problem.backend, progress));
    watch.lap("factorization");
  }
  if (!factor->is_factorized()) {
    map.rejection = Rejection::not_factorized;
    return map;
  }
  PinnedSolution solution = solve_lscm(energy, scaled_pins.held, *factor, progress, tolerance);
  ComplexVector& z = solution.vector;
  const auto inverse = [&](const ComplexVector& force) {
    PinnedSolution response = pinned_response(energy, force, *factor, progress, tolerance);
    ++map.solves;
    solution.change = std::max(solution.change, response.change);
    return std::move(response.vector);
  };
  push_and_pull(extenders, inverse, true, factor->max_diagonal(), z);
  watch.lap("solve");
  map.residual = solution.residual;
  map.eigenvalue = energy.value(z) / problem.form.value(z) * eigenvalue_unit(problem, Method::lscm);
  MapCheck check = measured_check(problem, z);
  check.eigenvalue = map.eigenvalue;
  check.error = solution.residual;
  check.error_limit =
      insignificant;  // of |L z| over the free vertices, relative to the extent and the largest entry of L
  check.may_be_mirrored = hold;
  map.turning_number = check.turning_number;
  map.rejection = check_map(z, check);
  if (map.rejection == Rejection::none && !(solution.change < single_epsilon)) map.rejection = Rejection::unresolved;
  if (map.rejection != Rejection::none) return map;
  map.whole = std::move(solution.vector);
  if (hold) {
    set_on_pins(problem, pins, map);
  } else {
    map.z = map.whole.head(problem.patch->n_vertices);
    place(problem, map.z);
  }
  watch.lap("placement");
  return map;
}

void set_on_pins(const SpectralProblem& problem, const Pins& pins, SpectralMap& map) {
  const ScaledPins scaled_pins = scaled(pins);
  map.z = map.whole.head(problem.patch->n_vertices);
  for (Complex& point : map.z) point = scaled_pins.origin + scaled_pins.unit * point;
  for (const auto& [vertex, position] : pins) map.z[vertex] = position;
}

PatchMap pinned(const SolveTask& task, PatchMap map, const Progress& progress) {
  if (map.rejection || !task.is_pinned() || task.is_constrained()) return map;
  const std::vector<Extender>& extenders = task.options.extenders;
  map.set(pinned_map(task.patch.problem, task.held, extenders, task.options.tolerance, progress, map.result.timings),
          task.options);
  map.result.eigenvalue_of = EigenvalueOf::map;
  return map;
}

PatchMap fitted_to_pins(const SolveTask& task, PatchMap map) {
  const Pins& pins = task.pins;
  ComplexVector& z = map.result.z;
  if (pins.empty() || task.is_held()) return map;
  if (task.is_pinned()) {
    const auto& [vertex, position] = *pins.begin();
    z.array() += position - z[vertex];
    z[vertex] = position;
  } else if (!fit_to_pins(z, pins, !task.is_constrained())) {
    throw same_position();
  } else if (task.attractors.empty()) {
    // A similarity meets two pins up to rounding, a translation one.
    for (const auto& [vertex, position] : pins) z[vertex] = position;
  }
  return map;
}

}  // namespace spectral_conformal
