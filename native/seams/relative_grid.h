#pragma once

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A grid relative to the extent of some points. Points of the same shape at another scale or place, which differ by
/// rounding errors, get the same coordinates on it, so that rounding decides nothing that is computed from these.
///
/// With the center c of the bounding box and its longest side s, the coordinates of x are the integer next to
/// sqrt(2) 2^27 (x - c) / s, times 2^-27: exact, symmetric about c, and finer than single precision. The factor is
/// irrational because the errors matter only halfway between two integers, where coordinates that are fractions of s
/// would lie by the thousand.
class RelativeGrid {
 public:
  /// points: (n, 3). Those that are not finite do not count.
  static RelativeGrid over(const Positions& points);

  /// (n, 3) the coordinates of the points on the grid, at most 0.71 in magnitude; NaN for what is not finite.
  Positions coordinates(const Positions& points) const;
  /// A length over its length on the grid; 0 if all points coincide.
  double unit() const { return unit_; }

 private:
  Eigen::RowVector3d center_ = Eigen::RowVector3d::Zero();
  double unit_ = 0;
};

}  // namespace spectral_conformal
