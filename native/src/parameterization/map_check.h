#pragma once

#include "spectral_conformal/step.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// What is known of a map when it is checked.
struct MapCheck {
  double eigenvalue = 0;         ///< the quotient of Eq. 5
  double error = 0;              ///< residual or last relative change, whichever tells how well the equations hold
  double error_limit = 0;        ///< what it must be less than
  double area = 0;               ///< signed
  int turning_number = 0;        ///< of the outer loop
  bool may_be_mirrored = false;  ///< held by pins: any area will do
  /// An eigenvector of Eq. 5 must have a turning number of 1, or -1 where the longest loop in 3D is a hole of the map.
  bool must_wind_once = false;
};

/// The one rule by which maps of all methods are accepted: finite, equations satisfied, positive area, turning number.
Rejection check_map(const ComplexVector& z, const MapCheck& check);

}  // namespace spectral_conformal
