#include "parameterization/patch_map.h"

#include <cstdlib>
#include <utility>

namespace spectral_conformal {

void PatchMap::set(SpectralMap&& map, const SolveOptions& options) {
  found = std::move(map);
  result.attempts = found.attempts;
  if (found.rejection != Rejection::none) {
    rejection = rejected(found, options);
    return;
  }
  rejection.reset();
  take_found();
  if (found.attempts > 1) add({StepKind::retried});
  if (std::abs(found.turning_number) != 1) add(counted(StepKind::winds, found.turning_number));
}

void PatchMap::take_found() {
  result.z = std::move(found.z);
  result.eigenvalue = found.eigenvalue;
  result.residual = found.residual;
  result.iterations = found.solves;
  result.turning_number = found.turning_number;
  result.polish_steps = found.polish_steps;
  if (result.polish_steps > 0) result.eigenvalue_of = EigenvalueOf::map;
}

Constraint constraint_of(const SolveOptions& options) {
  const bool is_rigid = options.hole_rigidity.value_or(0) != 0;
  if (options.has_extenders()) return is_rigid ? Constraint::extenders_and_rigidity : Constraint::extenders;
  if (options.method == Method::lscm) return Constraint::pins;
  if (is_rigid) return Constraint::rigidity;
  return options.constraints.empty() ? Constraint::none : Constraint::linear;
}

Step rejected(const SpectralMap& map, const SolveOptions& options) {
  const bool folds = map.rejection == Rejection::folded;
  Step step = rejected(map.rejection, folds ? map.flipped : map.turning_number);
  step.attempts = map.attempts;
  step.after = map.shift;
  step.constraint = constraint_of(options);
  return step;
}

}  // namespace spectral_conformal
