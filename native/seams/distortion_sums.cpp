#include "seams/distortion_sums.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace spectral_conformal {
namespace {

constexpr double ln4 = 1.386294361119890618834464242916;
/// How near two bounds of the median come by bisection before the faces between them are sorted.
constexpr double near_median = 1e-9;

/// The sum of what continues 2 cosh t beyond t = ln 4, by the sums of 1, t - ln 4 and its square.
double beyond_ln4(double s0, double s1, double s2) {
  // cosh ln 4 = 17 / 8, sinh ln 4 = 15 / 8
  return 17.0 / 8 * (2 * s0 + s2) + 15.0 / 4 * s1;
}

}  // namespace

double bounded_cosh(double t) {
  const double beyond = std::abs(t) - ln4;
  if (beyond <= 0) return 2 * std::cosh(t);
  return beyond_ln4(1, beyond, beyond * beyond);
}

DistortionSums::DistortionSums(const std::vector<double>& area, const std::vector<double>& log2_scale,
                               const std::vector<double>& qc) {
  const std::size_t n = area.size();
  std::vector<std::pair<double, std::size_t>> order(n);
  for (std::size_t f = 0; f < n; ++f) order[f] = {log2_scale[f], f};
  std::sort(order.begin(), order.end());
  log2_scale_.reserve(n);
  for (std::vector<double>* sums : {&area_, &shear_[0], &shear_[1], &shear_[2], &wider_}) sums->assign(n + 1, 0);
  narrower_.assign(n + 1, 0);
  std::vector<double> by_squared_scale(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto [scale, f] = order[i];
    // (s1^2 + s2^2) (1 + 1 / (s1 s2)^2), by the ratio and the product of the singular values.
    const double shear = area[f] * bounded_cosh(std::log(qc[f]));
    const double squared = std::exp2(2 * scale);
    log2_scale_.push_back(scale);
    area_[i + 1] = area_[i] + area[f];
    shear_[0][i + 1] = shear_[0][i] + shear;
    shear_[1][i + 1] = shear_[1][i] + shear * scale;
    shear_[2][i + 1] = shear_[2][i] + shear * scale * scale;
    wider_[i + 1] = wider_[i] + shear * squared;
    by_squared_scale[i] = shear / squared;
    qc_ += area[f] * qc[f];
  }
  // From the other end, where its terms are small: differences of sums keep their digits.
  for (std::size_t i = n; i > 0; --i) narrower_[i - 1] = narrower_[i] + by_squared_scale[i - 1];
}

std::size_t DistortionSums::below(double log2_scale) const {
  return static_cast<std::size_t>(std::lower_bound(log2_scale_.begin(), log2_scale_.end(), log2_scale) -
                                  log2_scale_.begin());
}

std::size_t DistortionSums::up_to(double log2_scale) const {
  return static_cast<std::size_t>(std::upper_bound(log2_scale_.begin(), log2_scale_.end(), log2_scale) -
                                  log2_scale_.begin());
}

double DistortionSums::energy(double log2_unit) const {
  // bounded_cosh of ln 4 times the distance to the unit, which is bounded from a distance of 1 on.
  const std::size_t n = log2_scale_.size();
  const std::size_t first = below(log2_unit - 1);
  const std::size_t last = up_to(log2_unit + 1);
  const double squared = std::exp2(2 * log2_unit);
  double sum = (wider_[last] - wider_[first]) / squared + (narrower_[first] - narrower_[last]) * squared;
  for (const auto& [from, to, sign] : {std::tuple{std::size_t{0}, first, -1.0}, std::tuple{last, n, 1.0}}) {
    // Of the distances d beyond 1, sign * (scale - unit) - 1, the sums of 1, d and d^2.
    const double end = log2_unit + sign;
    const double s0 = shear_[0][to] - shear_[0][from];
    const double s1 = shear_[1][to] - shear_[1][from];
    const double s2 = shear_[2][to] - shear_[2][from];
    const double d1 = sign * (s1 - end * s0);
    const double d2 = s2 - 2 * end * s1 + end * end * s0;
    sum += beyond_ln4(s0, ln4 * d1, ln4 * ln4 * d2);
  }
  return sum;
}

double DistortionSums::median_log2_scale(const std::vector<const DistortionSums*>& charts, double total) {
  double low = -2 * max_log2_scale;
  double high = max_log2_scale;
  while (high - low > near_median) {
    const double middle = low + (high - low) / 2;
    double area = 0;
    for (const DistortionSums* chart : charts) area += chart->area_up_to(middle);
    (2 * area >= total ? high : low) = middle;
  }
  double area = 0;
  std::vector<std::pair<double, double>> between;  // scales and areas
  for (const DistortionSums* chart : charts) {
    const std::size_t first = chart->up_to(low);
    area += chart->area_[first];
    for (std::size_t i = first; i < chart->up_to(high); ++i) {
      between.emplace_back(chart->log2_scale_[i], chart->area_[i + 1] - chart->area_[i]);
    }
  }
  if (between.empty()) return 0;
  std::sort(between.begin(), between.end());
  for (const auto& [scale, more] : between) {
    area += more;
    if (2 * area >= total) return scale;
  }
  return between.back().first;
}

}  // namespace spectral_conformal
