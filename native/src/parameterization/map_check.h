#pragma once

#include "spectral_conformal/step.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The data by which a map is checked.
struct MapCheck {
  double eigenvalue = 0;         ///< the quotient of Eq. 5
  double error = 0;              ///< residual or last relative change, whichever measures the method's error
  double error_limit = 0;        ///< exclusive upper bound of `error`
  double area = 0;               ///< signed
  int turning_number = 0;        ///< of the outer loop
  int flipped = 0;               ///< triangles
  double folded = 0;             ///< their share of the image area
  double max_folded = infinity;  ///< inclusive upper bound of `folded`
  bool may_be_mirrored = false;  ///< held by pins: any area is accepted
  /// For an eigenvector of Eq. 5: the turning number must be 1, or -1 where the longest loop in 3D is a hole of the
  /// map.
  bool must_wind_once = false;
};

/// The one acceptance rule for maps of all methods: finite, equations satisfied, positive area, turning number, folds.
Rejection check_map(const ComplexVector& z, const MapCheck& check);

}  // namespace spectral_conformal
