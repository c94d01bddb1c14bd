#include "parameterization/fallbacks.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// Cotangents up to 1e5 leave the corrections eleven of sixteen digits to converge with.
constexpr double min_relative_height = 1e-5;

/// Smaller is better: flipped triangles, then mean QC.
using Cost = std::tuple<int, double>;

Cost cost_of(const NormalizedPatch& patch, const ComplexVector& z) {
  const Distortion distortion = chart_distortion(patch, z);
  return {distortion.n_flipped(), distortion.mean_qc};
}

/// The rejected map unfolded, or an embedding. Empty where neither can be had without going round a vertex twice.
std::optional<FallbackMap> unfolded_map(const SpectralSolver& failed, const SpectralMap& rejected,
                                        const Progress& progress, Timings& timings) {
  Stopwatch watch(timings);
  const NormalizedPatch& patch = failed.patch();
  ComplexVector z;
  if (rejected.whole.size() > 0) z = rejected.whole.head(patch.n_vertices);
  FallbackMap result;
  try {
    result.unfolded = unfold(failed, {}, z, {true, false}, progress);
  } catch (const SolveFailure&) {
    return std::nullopt;  // the failure of the map itself is the one to report
  }
  watch.lap("unfolding");
  const FoldFreeMap& map = result.unfolded->fold_free;
  if (!map.is_locally_injective) return std::nullopt;
  result.fallback = map.is_embedding ? Fallback::tutte_embedding : Fallback::unfolded;
  result.weights = failed.energy().weights();
  result.boundary = failed.boundary();
  return result;
}

}  // namespace

std::optional<FallbackMap> solve_fallback(const SpectralSolver& failed, const SpectralMap& rejected,
                                          const SolveOptions& options, const Pins& attractors, double area_blend,
                                          const Progress& progress, Timings& timings, int& attempts) {
  const Weights weights = failed.energy().weights();
  const Weights other_weights = weights == Weights::uniform ? Weights::inverse_area : Weights::uniform;
  const BoundaryMeasure boundary = failed.boundary();
  const BoundaryMeasure other_boundary =
      boundary == BoundaryMeasure::length ? BoundaryMeasure::vertex : BoundaryMeasure::length;
  std::optional<FallbackMap> best;
  Cost least;
  const auto consider = [&](FallbackMap&& candidate, const ComplexVector& z) {
    const Cost cost = cost_of(failed.patch(), z);
    if (best && !(cost < least)) return;
    best = std::move(candidate);
    least = cost;
  };
  const auto consider_unfolded = [&] {
    std::optional<FallbackMap> unfolded = unfolded_map(failed, rejected, progress, timings);
    if (!unfolded) return;
    const ComplexVector z = unfolded->unfolded->fold_free.z;
    consider(std::move(*unfolded), z);
  };
  // It heeds neither a blend nor attractors.
  const bool is_last = area_blend > 0 || !attractors.empty();
  if (!is_last) consider_unfolded();
  FallbackMap candidates[3];
  candidates[0] = {{}, {}, Fallback::clamped_triangles, weights, boundary, 0, {}};
  candidates[1] = {{}, {}, Fallback::other_boundary, weights, other_boundary, 0, {}};
  candidates[2] = {{}, {}, Fallback::other_weights, other_weights, boundary, 0, {}};
  for (FallbackMap& candidate : candidates) {
    if (!SpectralSolver::has_form(failed.patch(), candidate.boundary)) continue;
    SpectralSolver other(failed, candidate.weights, candidate.boundary);
    if (candidate.fallback == Fallback::clamped_triangles) {
      candidate.clamped_triangles = other.clamp(min_relative_height);
      if (candidate.clamped_triangles == 0) continue;
    }
    if (area_blend > 0) {
      try {
        candidate.blend = blend_area(other, area_blend, progress);
      } catch (const SolveFailure&) {
        ++attempts;
        continue;  // the first failure is the one to report
      }
      other.stretch(candidate.blend->metric);
    }
    candidate.map = other.solve(options, attractors, progress, timings);
    attempts += candidate.map.attempts;
    if (candidate.map.rejection != Rejection::none) continue;
    other.place(candidate.map.z);
    const ComplexVector z = candidate.map.z;
    consider(std::move(candidate), z);
  }
  if (!best && is_last) consider_unfolded();
  return best;
}

}  // namespace spectral_conformal
