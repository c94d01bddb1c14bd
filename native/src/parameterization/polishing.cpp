#include "parameterization/polishing.h"

#include <optional>
#include <utility>

#include "layout/placement.h"
#include "relaxation/polish.h"
#include "spectral_conformal/distortion.h"

namespace spectral_conformal {
namespace {

/// The inverse of the quadratic form that the map of a task minimizes, on the maps that may replace it; none without
/// its factor.
Lbfgs::Inverse inverse_for(const SolveTask& task) {
  SpectralProblem& problem = task.patch.problem;
  const bool is_free = !task.is_constrained() && !task.is_held();
  ReducedFactor* const factor = is_free ? &problem.factor : problem.restricted_factor.get();
  if (!factor || !factor->is_factored()) return {};
  return [factor](const ComplexVector& b, ComplexVector& x) { x = factor->inverse(b); };
}

/// Of balanced maps: the steps for angles and for sizes. Of each, one more gains little.
constexpr int steps_for_angles = 3;
constexpr int steps_for_sizes = 2;
/// The share of the mean QC gained that sizes may cost. Of 720 islands (50 models of other people and those of
/// tests/benchmarks/models.py), mean QC was at most that of the better of Blender's CONFORMAL and ANGLE_BASED on 99 %,
/// as without this (99 %), and the sizes at least as even on 86 % (74 %). With all of the gain spent at a minimum: 95 %
/// and 94 %.
constexpr double share_for_sizes = 0.5;

}  // namespace

SpectralMap polished_map(const SpectralProblem& problem, const Lbfgs::Inverse& inverse, SpectralMap map, Polish polish,
                         bool is_eigenvector, const Progress& progress, Timings& timings) {
  Stopwatch watch(timings);
  const NormalizedPatch& patch = *problem.patch;
  const ConformalEnergy& energy = problem.energy;
  ComplexVector end = map.whole;
  if (!(signed_area(energy, end) > 0)) return map;
  const bool is_balanced = polish == Polish::balanced;
  PolishOptions angles;
  if (is_balanced) angles.max_steps = steps_for_angles;
  Polisher polisher = Polisher::of(energy, inverse, end);
  int steps = polisher.even_out_angles(end, angles, is_balanced ? part(progress, 0, 0.6) : progress);
  watch.lap("polish");
  if (steps == 0 || !end.allFinite()) return map;
  const auto mean_qc = [&](const ComplexVector& z) {
    return mean_quasi_conformal_distortion(energy.shapes(), patch.triangles, patch.triangle_weights,
                                           patch.triangles.size() - patch.n_virtual, z);
  };
  const ComplexVector unpolished = map.whole.head(patch.n_vertices);
  const double mean_qc_before = mean_qc(unpolished);
  const double gained = mean_qc_before - mean_qc(end.head(patch.n_vertices));
  if (is_balanced && gained > 0) {
    const double limit = mean_qc_before - (1 - share_for_sizes) * gained;
    PolishOptions sizes;
    sizes.max_steps = steps_for_sizes;
    sizes.is_allowed = [&](const ComplexVector& z) { return mean_qc(z.head(patch.n_vertices)) <= limit; };
    steps += polisher.even_out_sizes(end, sizes, part(progress, 0.6, 1));
    if (!end.allFinite()) return map;
  }
  // Usually the border proves that neither map overlaps itself.
  std::optional<int> covering_before;
  const auto covers_more = [&](const ComplexVector& z) {
    const int covering = n_covering_triangles(patch, z);
    if (covering > 0 && !covering_before) covering_before = n_covering_triangles(patch, unpolished);
    return covering > covering_before.value_or(0);
  };
  for (const double fraction : {1.0, 0.5, 0.25}) {
    SpectralMap moved = map;
    moved.whole = map.whole + fraction * (end - map.whole);
    const ComplexVector z = moved.whole.head(patch.n_vertices);
    const MapNumbers numbers = map_numbers(problem, moved.whole);
    if (numbers.turning_number != map.turning_number || !(signed_area(energy, z) > 0) || covers_more(z) ||
        !(mean_qc(z) < mean_qc_before)) {
      continue;
    }
    moved.eigenvalue = numbers.eigenvalue;
    if (is_eigenvector) moved.residual = numbers.residual;
    moved.polish_steps = steps;
    map = std::move(moved);
    break;
  }
  watch.lap("polish");
  return map;
}

PatchMap polished(const SolveTask& task, PatchMap map, const Progress& progress) {
  const SpectralProblem& problem = task.patch.problem;
  const NormalizedPatch& patch = *problem.patch;
  const Lbfgs::Inverse inverse = inverse_for(task);
  if (!inverse) return map;
  Parameterization& result = map.result;
  const bool is_eigenvector = !task.is_held() && !task.is_constrained();
  map.found = polished_map(problem, inverse, std::move(map.found), task.options.polish, is_eigenvector, progress,
                           result.timings);
  if (map.with_free_holes.whole.size() > 0) {
    SpectralMap free = polished_map(problem, inverse, std::move(map.with_free_holes), task.options.polish,
                                    is_eigenvector, progress, result.timings);
    const ComplexVector rigid_z = map.found.whole.head(patch.n_vertices);
    const ComplexVector free_z = free.whole.head(patch.n_vertices);
    const Distortion of_rigid = chart_distortion(patch, rigid_z);
    const Distortion of_free = chart_distortion(patch, free_z);
    const bool covers_more = may_cover_itself(patch, free_z) && !may_cover_itself(patch, rigid_z);
    if (of_free.mean_qc < of_rigid.mean_qc && of_free.n_flipped() <= of_rigid.n_flipped() && !covers_more) {
      map.found = std::move(free);
      result.hole_rigidity = 0;
    }
  }
  map.take_found();
  return map;
}

}  // namespace spectral_conformal
