#include "parameterization/constrained_map.h"

#include <cmath>
#include <utility>

#include "conformal/constrained_eigenproblem.h"
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

}  // namespace

SpectralMap constrained_map(const SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                            Timings& timings) {
  Stopwatch watch(timings);
  SpectralMap map;
  const ConstrainedEigenpair found =
      solve_constrained_eigenproblem(problem.energy, problem.form, options.constraints, problem.patch->positions,
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
  place_without_turn(problem, options.constraints, map.z);
  watch.lap("placement");
  return map;
}

PatchMap constrained(const SolveTask& task, PatchMap map, const Progress& progress) {
  if (map.rejection || !task.is_constrained()) return map;
  map.take(constrained_map(task.patch.problem, task.options, progress, map.result.timings), task.options);
  return map;
}

}  // namespace spectral_conformal
