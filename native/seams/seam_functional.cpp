#include "seams/seam_functional.h"

#include <algorithm>
#include <cmath>

#include "seams/seam_style.h"

namespace spectral_conformal {
namespace {

/// Exceeding a limit by as much as it allows costs as much as seams of this length, in sqrt(A). At ten, the seams of 12
/// organic meshes were 9 % longer at the same energy.
constexpr double limit_price = 3;
/// Fraction of the area within SeamSuggestionOptions::scale_limit, as documented there.
constexpr double enough_area = 0.95;
/// Least allowance for the energy, or the mean QC, above that of an isometry: with less, rounding errors would be worth
/// a seam.
constexpr double min_allowed = 1e-3;

double allowed(const SeamSuggestionOptions& options) { return std::max(options.energy_limit - 4, min_allowed); }

}  // namespace

double SeamFunctional::operator()(double cost, double open_rings, std::size_t n_islands,
                                  const MapQuality& quality) const {
  if (!quality.solved) return infinity;
  if (!(quality.area > 0)) return cost;
  return distortion(quality) + cost / std::sqrt(quality.area) +
         price_of_island() * (static_cast<double>(n_islands) + islands_per_ring * open_rings);
}

double SeamFunctional::price_of_island() const {
  return island_price * weights_of(options_->style).island / size_in_mesh_;
}

double SeamFunctional::beyond_sheet(const TrialMaps& charts) const {
  if (sheet_side_ == infinity) return 0;
  double sum = 0;
  for (const auto& mapped : charts) sum += std::max(longer_side(*mapped) - sheet_side_, 0.0);
  return sum;
}

double SeamFunctional::distortion(const MapQuality& quality) const {
  return quality.rms_excess / allowed(*options_) + beyond_limits(quality);
}

bool SeamFunctional::exceeds_limits(const MapQuality& quality, double share) const {
  return quality.energy > 4 + share * (options_->energy_limit - 4) || quality.within_limit < enough_area ||
         quality.mean_qc > 1 + share * (options_->qc_limit - 1);
}

double SeamFunctional::beyond_limits(const MapQuality& quality) const {
  const double too_much = std::max(quality.energy - options_->energy_limit, 0.0) / allowed(*options_) +
                          std::max(enough_area - quality.within_limit, 0.0) / (1 - enough_area);
  const double qc_gain =
      options_->qc_gain > 0 ? options_->qc_gain : std::max(options_->qc_limit - 1, min_allowed) / limit_price;
  // The gain refers to the whole mesh: a seam as long as the root of its area must lower its mean QC by the gain.
  const double of_mesh = options_->qc_gain > 0 ? size_in_mesh_ : 1;
  return limit_price * too_much + of_mesh * std::max(quality.mean_qc - options_->qc_limit, 0.0) / qc_gain;
}

}  // namespace spectral_conformal
