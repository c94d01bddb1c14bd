#include "parameterization/fallbacks.h"

#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "parameterization/area_blend.h"
#include "parameterization/attempts.h"
#include "parameterization/unfolding.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// Smaller is better: flipped triangles, then mean QC.
using Cost = std::tuple<int, double>;

Cost cost_of(const NormalizedPatch& patch, const ComplexVector& z) {
  const Distortion distortion = chart_distortion(patch, z);
  return {distortion.n_flipped(), distortion.mean_qc};
}

Step step_of(Fallback fallback, const SpectralProblem& other, int clamped_triangles) {
  if (fallback == Fallback::clamped_triangles) return counted(StepKind::clamped_thin, clamped_triangles);
  if (fallback == Fallback::other_boundary) {
    return {other.boundary == BoundaryMeasure::vertex ? StepKind::by_vertex : StepKind::by_length};
  }
  return {other.energy.weights() == Weights::uniform ? StepKind::uniform_weights : StepKind::inverse_area};
}

/// Searches for the substitute for a rejected map.
class FallbackSearch {
 public:
  FallbackSearch(const SolveTask& task, PatchMap rejected, const SolveOptions& options, const Progress& progress)
      : task_(task), rejected_(std::move(rejected)), options_(options), progress_(progress) {}

  /// Tries the rejected map unfolded, or an embedding; not if it would wind around a vertex twice.
  void unfold_rejected() {
    Stopwatch watch(rejected_.result.timings);
    const ComplexVector& whole = rejected_.found.whole;
    ComplexVector z;
    if (whole.size() > 0) z = whole.head(problem().patch->n_vertices);
    UnfoldedMap unfolded;
    try {
      unfolded = unfold(problem(), {}, z, {true, false, sizes_of(task_.patch)}, progress_);
    } catch (const SolveFailure&) {
      return;  // report the rejection of the map itself
    }
    watch.lap("unfolding");
    if (!unfolded.fold_free.is_locally_injective) return;
    const Fallback fallback = unfolded.fold_free.is_embedding ? Fallback::tutte_embedding : Fallback::unfolded;
    PatchMap map = with_unfolded(task_, rejected_, std::move(unfolded));
    map.result.fallback = fallback;
    consider(std::move(map));
  }

  /// Tries the map of another problem, blended by area_blend unless that is 0.
  void solve(Fallback fallback, Weights weights, BoundaryMeasure boundary, double area_blend) {
    if (!has_form(*problem().patch, boundary)) return;
    SpectralProblem other = other_problem(problem(), weights, boundary);
    PatchMap map = rejected_;
    map.add(*map.rejection);
    Parameterization& result = map.result;
    if (fallback == Fallback::clamped_triangles) {
      // Half the digits that cotangents may cost: 1e5 leaves eleven of sixteen for the corrections.
      result.clamped_triangles = other.clamp(std::sqrt(TriangleShape::min_height));
      if (result.clamped_triangles == 0) return;
    }
    map.add(step_of(fallback, other, result.clamped_triangles));
    result.fallback = fallback;
    result.weights = weights;
    result.boundary = boundary;
    AreaBlend blend;
    if (area_blend > 0) {
      blend = blend_area(other, area_blend, progress_);
      if (blend.rejection) {
        ++rejected_.result.attempts;
        return;
      }
      other.stretch(blend.metric);
      result.relaxation = blend.relaxed.status;
      result.scale_deviation_before = blend.scale_deviation_before;
    }
    SpectralMap found = attempted_map(other, options_, task_.attractors, progress_, rejected_.result.timings);
    rejected_.result.attempts += found.attempts;
    map.set(placed_map(other, std::move(found), rejected_.result.timings), options_);
    if (blend.relaxed.flipped > 0) map.add(counted(StepKind::relaxed_with_flips, blend.relaxed.flipped));
    if (!map.rejection) consider(std::move(map));
  }

  bool found() const { return best_.has_value(); }

  /// The best map, or the rejected one.
  PatchMap best() {
    if (!best_) return std::move(rejected_);
    best_->result.attempts = rejected_.result.attempts;
    best_->result.timings = rejected_.result.timings;
    return std::move(*best_);
  }

 private:
  const SpectralProblem& problem() const { return task_.patch.problem; }
  void consider(PatchMap&& map) {
    const Cost cost = cost_of(*problem().patch, map.result.z);
    if (best_ && !(cost < best_cost_)) return;
    best_ = std::move(map);
    best_cost_ = cost;
  }

  const SolveTask& task_;
  PatchMap rejected_;
  const SolveOptions& options_;
  const Progress& progress_;
  std::optional<PatchMap> best_;
  Cost best_cost_;
};

}  // namespace

PatchMap replaced(const SolveTask& task, PatchMap map, const Progress& progress) {
  SolveOptions options = task.options;
  options.hole_rigidity = map.result.hole_rigidity;
  SpectralProblem& problem = task.patch.problem;
  problem.drop_factor();  // other problems have factors of the same size
  const double area_blend = task.patch.blend ? 0 : task.patch.options.area_blend;
  const bool is_unfolding_last = area_blend > 0 || !task.attractors.empty();
  const Weights weights = problem.energy.weights();
  const Weights other_weights = weights == Weights::uniform ? Weights::inverse_area : Weights::uniform;
  const BoundaryMeasure boundary = problem.boundary;
  const BoundaryMeasure other_boundary =
      boundary == BoundaryMeasure::length ? BoundaryMeasure::vertex : BoundaryMeasure::length;

  FallbackSearch search(task, std::move(map), options, progress);
  if (!is_unfolding_last) search.unfold_rejected();
  search.solve(Fallback::clamped_triangles, weights, boundary, area_blend);
  search.solve(Fallback::other_boundary, weights, other_boundary, area_blend);
  search.solve(Fallback::other_weights, other_weights, boundary, area_blend);
  if (is_unfolding_last && !search.found()) search.unfold_rejected();
  return search.best();
}

}  // namespace spectral_conformal
