#include "seams/seam_functional.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "seams/distortion_sums.h"

namespace spectral_conformal {
namespace {

constexpr double island_price = 0.05;  // parting must save more than one short seam
/// What exceeds a limit by as much as the limit allows costs as much as seams of this length, in sqrt(A): ten made 12
/// organic meshes 9 % longer at the same energy.
constexpr double limit_price = 3;
/// Fraction of the area within SeamSuggestionOptions::scale_limit, as documented there.
constexpr double enough_area = 0.95;
/// The mean QC beyond its limit that is worth a seam of length sqrt(A), where options.qc_gain does not say.
constexpr double default_qc_gain = 0.01;
/// Of the energy that is allowed at least: less, and rounding errors would be worth a seam.
constexpr double min_allowed = 1e-3;

double allowed(const SeamSuggestionOptions& options) { return std::max(options.energy_limit - 4, min_allowed); }

}  // namespace

double SeamFunctional::operator()(double cost, const TrialMaps& charts, const MapQuality& quality) const {
  if (!quality.solved) return infinity;
  if (!(quality.area > 0)) return cost;
  return distortion(charts, quality) + cost / std::sqrt(quality.area) +
         island_price * static_cast<double>(charts.size());
}

double SeamFunctional::distortion(const TrialMaps& charts, const MapQuality& quality) const {
  double squares = 0;
  for (const auto& mapped : charts) {
    for (std::size_t i = 0; i < mapped->area.size(); ++i) {
      const double log_scale = 2 * M_LN2 * (mapped->log2_scale[i] - quality.median_log2_scale);
      const double excess = bounded_cosh(std::log(mapped->qc[i])) * bounded_cosh(log_scale) - 4;
      squares += mapped->area[i] * excess * excess;
    }
  }
  return std::sqrt(squares / quality.area) / allowed(options_) + beyond_limits(quality);
}

bool SeamFunctional::exceeds_limits(const MapQuality& quality) const { return beyond_limits(quality) > 0; }

double SeamFunctional::beyond_limits(const MapQuality& quality) const {
  const double too_much = std::max(quality.energy - options_.energy_limit, 0.0) / allowed(options_) +
                          std::max(enough_area - quality.within_limit, 0.0) / (1 - enough_area);
  const double qc_gain = options_.qc_gain > 0 ? options_.qc_gain : default_qc_gain;
  // The gain is for the whole mesh: a seam of its length sqrt(A) costs what lowers its mean by that.
  const double of_mesh = mesh_area_ > 0 ? std::sqrt(quality.area / mesh_area_) : 1;
  return limit_price * too_much + of_mesh * std::max(quality.mean_qc - options_.qc_limit, 0.0) / qc_gain;
}

}  // namespace spectral_conformal
