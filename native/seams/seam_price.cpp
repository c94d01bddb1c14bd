#include "seams/seam_price.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {
namespace {

constexpr double flat_price = 2;
constexpr double sharp_price = 0.1;
constexpr double shown_angle = 20 * M_PI / 180;

}  // namespace

double seam_price(double theta, bool is_concave) {
  const double ratio = (is_concave ? 2 : 1) * theta / shown_angle;
  return std::max(sharp_price, flat_price / (1 + ratio * ratio));
}

}  // namespace spectral_conformal
