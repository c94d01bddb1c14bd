#include "seams/seam_functional.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "seams/distortion_sums.h"

namespace spectral_conformal {
namespace {

constexpr double island_price = 0.05;

}  // namespace

double SeamFunctional::operator()(const std::vector<int>& seams, const TrialMaps& charts) const {
  const MapQuality quality = map_quality(charts, 2);  // a limit that is not asked for
  if (!quality.solved) return std::numeric_limits<double>::infinity();
  if (!(quality.area > 0)) return price(seams);
  double fourth_powers = 0;
  for (const auto& mapped : charts) {
    for (std::size_t i = 0; i < mapped->area.size(); ++i) {
      const double log_scale = 2 * M_LN2 * (mapped->log2_scale[i] - quality.median_log2_scale);
      const double excess = bounded_cosh(std::log(mapped->qc[i])) * bounded_cosh(log_scale) - 4;
      fourth_powers += mapped->area[i] * std::pow(excess, 4);
    }
  }
  return std::pow(fourth_powers / quality.area, 0.25) / (energy_limit_ - 4) + price(seams) / std::sqrt(quality.area) +
         island_price * static_cast<double>(charts.size());
}

double SeamFunctional::price(const std::vector<int>& seams) const {
  double sum = 0;
  for (const int e : seams) {
    sum += price_[static_cast<std::size_t>(e)] * graph_.edges()[static_cast<std::size_t>(e)].length;
  }
  return sum;
}

}  // namespace spectral_conformal
