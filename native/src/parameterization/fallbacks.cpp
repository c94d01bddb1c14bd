#include "parameterization/fallbacks.h"

#include <utility>

#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// Cotangents up to 1e5 leave the corrections eleven of sixteen digits to converge with.
constexpr double min_relative_height = 1e-5;

}  // namespace

std::optional<FallbackMap> solve_fallback(const SpectralSolver& failed, const SolveOptions& options,
                                          const Pins& attractors, double area_blend, const Progress& progress,
                                          Timings& timings, int& attempts) {
  const Weights weights = failed.energy().weights();
  const Weights other_weights = weights == Weights::uniform ? Weights::inverse_area : Weights::uniform;
  const BoundaryMeasure boundary = failed.boundary();
  const BoundaryMeasure other_boundary =
      boundary == BoundaryMeasure::length ? BoundaryMeasure::vertex : BoundaryMeasure::length;
  FallbackMap candidates[3];
  candidates[0] = {{}, Fallback::clamped_triangles, weights, boundary, 0, {}};
  candidates[1] = {{}, Fallback::other_boundary, weights, other_boundary, 0, {}};
  candidates[2] = {{}, Fallback::other_weights, other_weights, boundary, 0, {}};
  for (FallbackMap& candidate : candidates) {
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
    if (candidate.map.rejection == Rejection::none) return std::move(candidate);
  }
  return std::nullopt;
}

}  // namespace spectral_conformal
