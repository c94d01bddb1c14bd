#include "parameterization/area_blend.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "parameterization/attempts.h"

namespace spectral_conformal {

AreaBlend blend_area(const SpectralProblem& problem, double amount, const Progress& progress) {
  const NormalizedPatch& patch = *problem.patch;
  const ConformalEnergy& energy = problem.energy;
  AreaBlend result;
  Timings timings;  // all of it counts as the blend
  SpectralProblem conformal = other_problem(problem, energy.weights(), problem.boundary);
  SpectralMap map = attempted_map(conformal, {}, {}, part(progress, 0.0, 0.2), timings);
  if (map.rejection != Rejection::none) {
    result.rejection = rejected(map, {});
    return result;
  }
  conformal.drop_factor();
  result.scale_deviation_before = chart_distortion(patch, map.whole.head(patch.n_vertices)).log2_scale_deviation;
  result.relaxed = relax_to_isometry(patch.triangles, energy.energy_shapes(), patch.triangle_weights, patch.n_virtual,
                                     std::move(map.whole), problem.backend, {}, part(progress, 0.2, 1.0));
  const ComplexVector& z = result.relaxed.z;
  result.metric.reserve(patch.triangles.size());
  for_each_polled(patch.triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = patch.triangles[t];
    result.metric.push_back(blend(metric_of_map(energy.energy_shapes()[t], z[b] - z[a], z[c] - z[a]), amount));
  });
  return result;
}

std::optional<Step> blend_once(PreparedPatch& patch, const Progress& progress) {
  if (patch.blend || !(patch.options.area_blend > 0)) return {};
  Timings timings = patch.timings;
  Stopwatch watch(timings);
  const AreaBlend blend = blend_area(patch.problem, patch.options.area_blend, progress);
  if (blend.rejection) return blend.rejection;
  watch.lap("area blend");
  patch.problem.stretch(blend.metric);
  patch.timings.swap(timings);
  patch.blend = {blend.relaxed.status, blend.scale_deviation_before, blend.relaxed.flipped};
  return {};
}

PatchMap measured_blend(const SolveTask& task, PatchMap map) {
  constexpr double visible = 0.05;  // spread of scale, of 3.5 %
  constexpr double little = 0.2;    // share of the requested fall
  Parameterization& result = map.result;
  if (!result.relaxation) return map;
  const double before = result.scale_deviation_before;
  const double after = chart_distortion(*task.patch.problem.patch, result.z).log2_scale_deviation;
  result.scale_deviation = after;
  if (!(before > visible) || !std::isfinite(before) || !std::isfinite(after)) return map;
  if (after < before * (1 - little * task.patch.options.area_blend)) return map;
  Step step = changed(StepKind::blended_little, before, after);
  step.relaxation = *result.relaxation;
  map.add(step);
  return map;
}

}  // namespace spectral_conformal
