#include "parameterization/attempts.h"

#include <utility>

namespace spectral_conformal {
namespace {

/// Copes with rounding: a hundred times the shift, a start without preferred shape, and a tenth of the error.
constexpr Attempt second_attempt{1e-10, 1e-10, {0.1, 1200, 1}};

}  // namespace

SpectralMap retried_map(SpectralProblem& problem, SpectralMap map, const SolveOptions& options, const Pins& attractors,
                        const Progress& progress, Timings& timings) {
  if (map.rejection == Rejection::none || map.attempts > 1 || !options.second_attempt) return map;
  // Without a factor the shift was already raised to its limit.
  if (map.rejection == Rejection::not_factorized) return map;
  // For a strongly negative extender the true optimum winds or folds over, so another attempt would end there too: the
  // pair meets where the map branches. Likewise under linear constraints (nearest_map.h).
  const bool may_wind = options.has_extenders_or_rigidity() || !options.constraints.empty();
  if (map.is_misshapen() && may_wind) return map;
  // Progress must not fall, and the failed attempt has used it up.
  const Progress rest = [&progress](double, const char* phase) { return !progress || progress(1.0, phase); };
  map = spectral_map(problem, options, attractors, second_attempt, rest, timings);
  map.attempts = 2;
  return map;
}

SpectralMap attempted_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                          const Progress& progress, Timings& timings) {
  SpectralMap map = spectral_map(problem, options, attractors, first_attempt, progress, timings);
  return retried_map(problem, std::move(map), options, attractors, progress, timings);
}

PatchMap spectral(const SolveTask& task, PatchMap map, const Progress& progress) {
  map.set(spectral_map(task.patch.problem, task.options, task.attractors, first_attempt, progress, map.result.timings),
          task.options);
  // Without a factor no form was used.
  if (map.found.rejection != Rejection::not_factorized) {
    map.result.hole_rigidity = task.options.hole_rigidity.value_or(0);
  }
  return map;
}

PatchMap retried(const SolveTask& task, PatchMap map, const Progress& progress) {
  if (map.found.rejection == Rejection::none) return map;
  map.set(retried_map(task.patch.problem, std::move(map.found), task.options, task.attractors, progress,
                      map.result.timings),
          task.options);
  return map;
}

}  // namespace spectral_conformal
