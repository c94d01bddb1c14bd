#include "parameterization/unfolding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "layout/placement.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// The vertices that unfolding must not move: the pins, and those that linear constraints place in z (V,).
Pins kept_vertices(const SolveTask& task, const ComplexVector& z) {
  Pins kept = task.held;
  const LinearEquations& equations = task.options.constraints;
  const auto keep = [&](int coordinate) { kept.emplace(coordinate / 2, z[coordinate / 2]); };
  for (const int coordinate : equations.coordinate) keep(coordinate);
  for (const auto& [coordinate, value] : equations.held) keep(coordinate);
  return kept;
}

}  // namespace

UnfoldedMap unfold(const SpectralProblem& problem, const Pins& held, const ComplexVector& z,
                   const UnfoldingOptions& options, const Progress& progress) {
  const NormalizedPatch& patch = *problem.patch;
  const ConformalEnergy& energy = problem.energy;
  std::vector<char> held_vertices(held.empty() ? 0 : static_cast<std::size_t>(patch.n_vertices), 0);
  for (const auto& pin : held) held_vertices[static_cast<std::size_t>(pin.first)] = 1;
  std::vector<BoundaryLoop> loops{patch.outer};
  loops.insert(loops.end(), patch.inner.begin(), patch.inner.end());
  UnfoldedMap result;
  result.mean_qc_before = z.size() > 0 ? chart_distortion(patch, z).mean_qc : unmeasured;
  // Pins may hold the map mirrored, which is not a fold.
  const bool mirrored = !held.empty() && signed_area(energy, z) < 0;
  FoldFreeMap& map = result.fold_free;
  map = fold_free_map({energy, patch.surface(), loops, held_vertices, problem.backend, options.is_refused,
                       options.moves_apart, options.sizes},
                      mirrored ? ComplexVector(z.conjugate()) : z, progress);
  if (mirrored) map.z = map.z.conjugate().eval();
  result.changed = options.is_refused || map.is_embedding || map.flipped != map.flipped_before ||
                   map.covered_itself != map.covers_itself;
  result.mean_qc = result.mean_qc_before;
  if (!result.changed) return result;
  if (held.empty() && !place(problem, map.z)) {
    throw SolveFailure(rejected(Rejection::no_area));
  }
  const MapNumbers after = map_numbers(problem, with_virtual_vertices(patch, map.z));
  result.turning_number = map.turning_number;
  result.eigenvalue = after.eigenvalue;
  result.residual = after.residual;
  result.mean_qc = chart_distortion(patch, map.z).mean_qc;
  return result;
}

double sizes_of(const PreparedPatch& patch) { return patch.has_metric ? 0 : patch.options.area_blend; }

PatchMap with_unfolded(const SolveTask& task, PatchMap map, UnfoldedMap&& unfolded) {
  const PatchOptions& requested = task.patch.options;
  FoldFreeMap& fold_free = unfolded.fold_free;
  Parameterization& result = map.result;
  const bool had_map = !map.rejection;
  if (map.rejection) map.add(*map.rejection);
  map.rejection.reset();
  if (unfolded.changed) {
    result.z = std::move(fold_free.z);
    result.turning_number = unfolded.turning_number;
    result.eigenvalue = unfolded.eigenvalue;
    result.eigenvalue_of = EigenvalueOf::map;
    result.residual = unfolded.residual;
    // The substitute for a rejected map may have been unfolded before; now its parts are moved apart.
    if (std::isnan(result.mean_qc_before) && !result.is_embedding) result.mean_qc_before = unfolded.mean_qc_before;
    result.unfolded += fold_free.flipped_before - (fold_free.is_embedding ? 0 : fold_free.flipped);
    result.is_embedding = result.is_embedding || fold_free.is_embedding;
    // The quotient refers to the patch's own energy and form.
    result.weights = requested.weights;
    result.boundary = requested.boundary;
    result.clamped_triangles = 0;
    if (fold_free.is_embedding) result.fallback = Fallback::tutte_embedding;
  }
  const double before = unfolded.mean_qc_before;
  const double after = unfolded.mean_qc;
  if (fold_free.is_embedding && !fold_free.came_apart_embedded) {
    map.add(changed(StepKind::embedded, had_map ? before : unmeasured, after));
  } else if (fold_free.flipped < fold_free.flipped_before) {
    map.add(changed(StepKind::unfolded, before, after, fold_free.flipped_before - fold_free.flipped));
  }
  if (fold_free.covers_itself) {
    map.add({StepKind::covers_itself});
  } else if (fold_free.covered_itself) {
    const bool is_embedded = fold_free.came_apart_embedded;
    map.add(changed(is_embedded ? StepKind::moved_apart_embedded : StepKind::moved_apart, before, after));
  }
  if (fold_free.flipped > 0 || !fold_free.is_locally_injective) {
    Step step = fold_free.flipped > 0 ? counted(StepKind::still_flipped, fold_free.flipped)
                                      : counted(StepKind::not_injective, result.turning_number);
    if (task.is_held()) {
      step.constraint = Constraint::pins;
    } else if (task.is_constrained()) {
      step.constraint = Constraint::linear;
    }
    map.add(step);
  }
  return map;
}

PatchMap unfolded(const SolveTask& task, PatchMap map, const Progress& progress) {
  SpectralProblem& problem = task.patch.problem;
  if (map.rejection) problem.drop_factor();  // the embedding makes its own factors
  Stopwatch watch(map.result.timings);
  UnfoldedMap unfolded =
      unfold(problem, kept_vertices(task, map.result.z), map.result.z, {false, true, sizes_of(task.patch)}, progress);
  map = with_unfolded(task, std::move(map), std::move(unfolded));
  watch.lap("unfolding");
  return map;
}

}  // namespace spectral_conformal
