#pragma once

#include <algorithm>
#include <array>

namespace spectral_conformal {

/// The real roots of c0 + c1 t + c2 t^2, unordered, without cancellation (Press et al., Numerical Recipes, 2007,
/// Section 5.6); missing roots are infinite.
std::array<double, 2> quadratic_roots(double c0, double c1, double c2);

/// The smallest root in (0, limit), or the limit, which may be infinite; c0 > 0. Computes roots only if there is one.
inline double first_root(double c0, double c1, double c2, double limit) {
  const bool is_positive_at_end = c0 + limit * (c1 + limit * c2) > 0;
  const bool has_minimum_before = c2 > 0 && c1 < 0 && -c1 < 2 * c2 * limit;
  if (is_positive_at_end && (!has_minimum_before || c1 * c1 < 4 * c0 * c2)) return limit;
  double first = limit;
  for (const double root : quadratic_roots(c0, c1, c2)) {
    if (root > 0) first = std::min(first, root);
  }
  return first;
}

}  // namespace spectral_conformal
