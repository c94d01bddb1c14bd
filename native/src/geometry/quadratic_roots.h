#pragma once

#include <array>

namespace spectral_conformal {

/// The real roots of c0 + c1 t + c2 t^2 in no order, without cancellation (Press et al., Numerical Recipes, 2007,
/// Section 5.6); those that do not exist are infinite.
std::array<double, 2> quadratic_roots(double c0, double c1, double c2);

}  // namespace spectral_conformal
