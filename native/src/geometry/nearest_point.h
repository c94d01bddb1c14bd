#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Finds the nearest of some points of the plane in a k-d tree (Bentley 1975): built in O(n log n), asked in O(log n)
/// where the points are not all about equally far.
class NearestPoint {
 public:
  /// Points, finite, one at least.
  explicit NearestPoint(const std::vector<Complex>& points);

  /// The index of the nearest point, the smallest of equally near ones.
  int to(Complex place) const;

 private:
  struct Leaf {
    Complex point;
    int index;
  };

  void build(int first, int last);

  /// The middle of each range splits it; in place, without nodes.
  std::vector<Leaf> leaves_;
  std::vector<char> axis_;  ///< across which the leaf at this place splits its range
};

}  // namespace spectral_conformal
