#include "parameterization/map_check.h"

#include <cmath>
#include <cstdlib>

namespace spectral_conformal {
Rejection check_map(const ComplexVector& z, const MapCheck& check) {
  if (!z.allFinite()) return Rejection::not_finite;
  if (!std::isfinite(check.eigenvalue)) return Rejection::collapsed;
  if (!(check.error < check.error_limit)) return Rejection::unresolved;
  if (!check.may_be_mirrored && !(check.area > 0 && std::isfinite(check.area))) return Rejection::no_area;
  if (check.must_wind_once && std::abs(check.turning_number) != 1) return Rejection::winding;
  if (check.folded > check.max_folded) return Rejection::folded;
  return Rejection::none;
}

}  // namespace spectral_conformal
