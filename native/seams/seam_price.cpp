#include "seams/seam_price.h"

#include <algorithm>
#include <cmath>

#include "spectral_conformal/types.h"

namespace spectral_conformal {
namespace {

/// Across a flat region; a seam at `shown_angle` costs 1.
constexpr double flat_price = 2;
/// Not 0, so that the shorter of two paths along sharp edges wins.
constexpr double sharp_price = 0.1;
/// From about this angle on, shading shows an edge.
constexpr double shown_angle = 20 * pi / 180;

}  // namespace

double seam_price(double theta, bool is_concave) {
  const double ratio = (is_concave ? 2 : 1) * theta / shown_angle;
  return std::max(sharp_price, flat_price / (1 + ratio * ratio));
}

double marked_price(double price, double strength) {
  return std::pow(price, 1 - strength) * std::pow(sharp_price, strength);
}

}  // namespace spectral_conformal
