#include "parameterization/pinned_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "conformal/correction.h"
#include "conformal/lscm.h"
#include "layout/placement.h"
#include "mesh/boundary_loops.h"
#include "quality/turning_number.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// |L z| of a pinned map over its free vertices, relative to its extent and the largest entry of L: what the refinement
/// leaves is near 1e-16.
constexpr double pinned_residual_limit = 1e-10;

/// Pins in a unit of their own, so that pins of any magnitude solve alike: z = origin + unit * held.
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
  // Rounding alone can make an extent of the smallest numbers.
  const bool equal =
      std::all_of(pins.begin(), pins.end(), [&pins](const auto& pin) { return pin.second == pins.begin()->second; });
  if (equal || !(result.unit > 0) || !std::isfinite(result.unit)) {
    throw InvalidMesh("All pins have the same position, so the map would shrink to a point; move one of them.");
  }
  for (const auto& [vertex, position] : pins) result.held[vertex] = (position - result.origin) / result.unit;
  return result;
}

/// The two farthest boundary vertices, at their distance in 3D (section 3.1).
Pins farthest_pins(const SpectralSolver& solver) {
  const NormalizedPatch& patch = solver.patch();
  const auto pair = farthest_boundary_vertices(patch.outer, patch.positions, solver.energy().matrix());
  const double distance = (patch.positions.row(pair[1]) - patch.positions.row(pair[0])).norm();
  return {{pair[0], 0.0}, {pair[1], distance > 0 ? distance : 1.0}};
}

}  // namespace

SpectralMap solve_pinned(const SpectralSolver& solver, const Pins& pins, const Progress& progress, Timings& timings) {
  Stopwatch watch(timings);
  const NormalizedPatch& patch = solver.patch();
  const ConformalEnergy& energy = solver.energy();
  const bool hold = pins.size() >= 2;
  const ScaledPins scaled_pins = hold ? scaled(pins) : ScaledPins{farthest_pins(solver), 0, 1};
  SpectralMap map;
  map.attempts = 1;
  map.solves = 1;
  PinnedSolution solution = solve_lscm(energy, scaled_pins.held, solver.backend(), progress);
  watch.lap("solve");
  if (!solution.is_factorized) {
    map.rejection = Rejection::not_factorized;
    return map;
  }
  ComplexVector& z = solution.vector;
  const bool finite = z.allFinite();
  const double lambda = energy.value(z) / solver.form().value(z);
  map.residual = solution.residual;
  map.eigenvalue = lambda * solver.eigenvalue_unit(Method::lscm);
  if (finite) map.turning_number = turning_number(patch.outer, patch.triangles, patch.triangle_weights, z);
  MapCheck check;
  check.eigenvalue = map.eigenvalue;
  check.error = solution.residual;
  check.error_limit = pinned_residual_limit;
  check.area = finite ? signed_area(energy, z) : 0;
  check.turning_number = map.turning_number;
  check.may_be_mirrored = hold;
  map.rejection = check_map(z, check);
  if (map.rejection == Rejection::none && !(solution.change < resolved_change)) map.rejection = Rejection::unresolved;
  if (map.rejection != Rejection::none) return map;
  map.z = z.head(patch.n_vertices);
  if (hold) {
    for (Complex& point : map.z) point = scaled_pins.origin + scaled_pins.unit * point;
    for (const auto& [vertex, position] : pins) map.z[vertex] = position;
  } else {
    solver.place(map.z);
  }
  watch.lap("placement");
  return map;
}

void move_onto_pin(const Pins& pin, ComplexVector& z) {
  const auto& [vertex, position] = *pin.begin();
  z.array() += position - z[vertex];
  z[vertex] = position;
}

}  // namespace spectral_conformal
