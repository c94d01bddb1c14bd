#include "parameterization/hole_rigidity.h"

#include <utility>
#include <vector>

#include "parameterization/attempts.h"

namespace spectral_conformal {
namespace {

/// Up to this mean QC, rigidity is not worth its solves.
constexpr double hardly_distorted = 1.02;

struct Quality {
  int flipped = 0;
  double mean_qc = 0;
  double max_qc = 0;
  bool may_cover_itself = false;
};

Quality quality_of(const NormalizedPatch& patch, const SpectralMap& map) {
  const ComplexVector z = map.whole.head(patch.n_vertices);
  const Distortion distortion = chart_distortion(patch, z);
  return {distortion.n_flipped(), distortion.mean_qc, distortion.max_qc, may_cover_itself(patch, z)};
}

/// From nearly free holes to nearly rigid ones.
constexpr double rigidities[] = {0.1, 0.3, 1, 3, 10};

/// Solves for one rigidity after another and keeps the best map.
class RigiditySearch {
 public:
  RigiditySearch(SpectralProblem& problem, const SolveOptions& options, const Progress& progress, Timings& timings)
      : problem_(problem), options_(options), progress_(progress), timings_(timings) {}

  /// Lowers a rigidity to the first map without flipped triangles, or takes the map with the fewest.
  RigidMap lower(double rigidity) {
    std::vector<double> descending{rigidity, 0};
    for (const double each : rigidities) {
      if (each < rigidity) descending.insert(descending.begin() + 1, each);
    }
    for (const double each : descending) {
      SpectralMap map = solve(each);
      if (map.rejection != Rejection::none) {
        const bool has_factor = map.rejection != Rejection::not_factorized;
        if (!found_) best_.map = std::move(map);
        if (!has_factor) break;
        continue;
      }
      const Quality quality = quality_of(*problem_.patch, map);
      if (found_ && quality.flipped >= best_quality_.flipped) continue;
      set_best(std::move(map), each, quality);
      if (quality.flipped == 0) break;
    }
    return std::move(best_);
  }

  /// Chooses by mean QC.
  RigidMap choose() {
    best_.map = solve(0);
    if (best_.map.rejection == Rejection::not_factorized) return std::move(best_);
    double worst = infinity;
    if (best_.map.rejection == Rejection::none) {
      best_quality_ = quality_of(*problem_.patch, best_.map);
      found_ = true;
      if (best_quality_.flipped == 0 && best_quality_.mean_qc <= hardly_distorted) return std::move(best_);
      worst = 2 * best_quality_.max_qc;
    }
    for (const double rigidity : rigidities) {
      SpectralMap map = solve(rigidity);
      if (map.rejection != Rejection::none) continue;
      const Quality quality = quality_of(*problem_.patch, map);
      // If the map of rigidity 0 is rejected, only a map without flipped triangles beats the fallbacks (fallbacks.h).
      const bool is_better = found_
                                 ? quality.flipped <= best_quality_.flipped && quality.mean_qc < best_quality_.mean_qc
                                 : quality.flipped == 0;
      if (!is_better || quality.max_qc > worst ||
          (found_ && quality.may_cover_itself && !best_quality_.may_cover_itself))
        continue;
      if (found_ && best_.rigidity == 0) best_.free = std::move(best_.map);
      set_best(std::move(map), rigidity, quality);
    }
    return std::move(best_);
  }

 private:
  SpectralMap solve(double rigidity) {
    SolveOptions changed = options_;
    changed.hole_rigidity = rigidity;
    // Progress must not fall, and the first solve has used it up.
    const bool is_first = best_.attempts == 0;
    const Progress rest = [&](double fraction, const char* phase) {
      return !progress_ || progress_(is_first ? fraction : 1.0, phase);
    };
    SpectralMap map = attempted_map(problem_, changed, {}, rest, timings_);
    best_.attempts += map.attempts;
    return map;
  }
  void set_best(SpectralMap&& map, double rigidity, const Quality& quality) {
    best_.map = std::move(map);
    best_.rigidity = rigidity;
    best_quality_ = quality;
    found_ = true;
  }

  SpectralProblem& problem_;
  const SolveOptions& options_;
  const Progress& progress_;
  Timings& timings_;
  RigidMap best_;
  Quality best_quality_;  ///< of the best
  bool found_ = false;    ///< whether the best passes its checks
};

}  // namespace

RigidMap map_with_rigid_holes(SpectralProblem& problem, const SolveOptions& options, const Progress& progress,
                              Timings& timings) {
  RigiditySearch search(problem, options, progress, timings);
  return options.hole_rigidity ? search.lower(*options.hole_rigidity) : search.choose();
}

PatchMap with_rigid_holes(const SolveTask& task, PatchMap map, const Progress& progress) {
  SolveOptions options = task.options;
  const std::optional<double> requested = options.hole_rigidity;
  RigidMap rigid = map_with_rigid_holes(task.patch.problem, options, progress, map.result.timings);
  if (requested && rigid.rigidity < *requested)
    map.add(changed(StepKind::lowered_rigidity, *requested, rigid.rigidity));
  options.hole_rigidity = map.result.hole_rigidity = rigid.rigidity;
  map.set(std::move(rigid.map), options);
  map.result.attempts = rigid.attempts;
  if (rigid.free) map.with_free_holes = std::move(*rigid.free);
  return map;
}

}  // namespace spectral_conformal
