#include "geometry/quadratic_roots.h"

#include <cmath>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

std::array<double, 2> quadratic_roots(double c0, double c1, double c2) {
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  if (!(discriminant >= 0)) return {infinity, infinity};
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
  return {q != 0 ? c0 / q : infinity, c2 != 0 ? q / c2 : infinity};
}

}  // namespace spectral_conformal
