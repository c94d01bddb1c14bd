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

Step rejected(const SpectralMap& map, const SolveOptions& options) {
  Step step = rejected(map.rejection, map.turning_number);
  step.attempts = map.attempts;
  step.after = map.shift;
  const bool is_rigid = options.hole_rigidity.value_or(0) != 0;
  if (options.has_extenders()) {
    step.constraint = is_rigid ? Constraint::extenders_and_rigidity : Constraint::extenders;
  } else if (options.method == Method::lscm) {
    step.constraint = Constraint::pins;
  } else if (is_rigid) {
    step.constraint = Constraint::rigidity;
  } else if (!options.constraints.empty()) {
    step.constraint = Constraint::linear;
  }
  return step;
}

}  // namespace spectral_conformal
