#include "parameterization/polishing.h"

#include <optional>
#include <utility>

#include "layout/placement.h"
#include "parameterization/pinned_map.h"
#include "relaxation/polish.h"
#include "spectral_conformal/distortion.h"

namespace spectral_conformal {

SpectralMap polished_map(const SpectralProblem& problem, SpectralMap map, bool is_held, const Progress& progress,
                         Timings& timings) {
  if (is_held ? problem.pinned_factor == nullptr : !problem.is_factored()) return map;
  Stopwatch watch(timings);
  const NormalizedPatch& patch = *problem.patch;
  const ConformalEnergy& energy = problem.energy;
  ComplexVector end = map.whole;
  if (is_held && !(signed_area(energy, end) > 0)) return map;
  const auto free_inverse = [&problem](const ComplexVector& b, ComplexVector& x) {
    problem.factor.factorization->solve(b, x);
    x.array() -= x.mean();  // the shifted energy hardly controls the constant
  };
  const auto held_inverse = [&problem](const ComplexVector& b, ComplexVector& x) {
    problem.pinned_factor->solve_on_all(b, x);
  };
  const int steps = polish(energy, is_held ? Lbfgs::Inverse(held_inverse) : free_inverse, end, {}, progress);
  watch.lap("polish");
  if (steps == 0 || !end.allFinite()) return map;
  const auto mean_qc = [&](const ComplexVector& z) {
    return mean_quasi_conformal_distortion(energy.shapes(), patch.triangles, patch.triangle_weights,
                                           patch.triangles.size() - patch.n_virtual, z);
  };
  const ComplexVector unpolished = map.whole.head(patch.n_vertices);
  const double mean_qc_before = mean_qc(unpolished);
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
    if (!is_held) moved.residual = numbers.residual;
    moved.polish_steps = steps;
    map = std::move(moved);
    break;
  }
  watch.lap("polish");
  return map;
}

PatchMap polished(const SolveTask& task, PatchMap map, const Progress& progress) {
  const PreparedPatch& prepared = task.patch;
  const NormalizedPatch& patch = *prepared.problem.patch;
  // Do not polish away a requested shape.
  const bool is_shaped = prepared.blend || prepared.has_metric || task.options.hole_rigidity.value_or(0) != 0;
  const bool is_held = !task.held.empty();
  if (map.rejection || !task.options.polish || !(task.is_free() || is_held) || is_shaped) return map;
  Parameterization& result = map.result;
  map.found = polished_map(prepared.problem, std::move(map.found), is_held, progress, result.timings);
  if (is_held && map.found.polish_steps > 0) set_on_pins(prepared.problem, task.held, map.found);
  if (map.with_free_holes.whole.size() > 0) {
    SpectralMap free = polished_map(prepared.problem, std::move(map.with_free_holes), false, progress, result.timings);
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
