#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Finds the nearest of some points of the plane in a k-d tree (Bentley 1975): built in O(n log n), queried in O(log n)
/// unless most points are about equally far.
class NearestPoint {
 public:
  /// points: finite, at least one.
  static NearestPoint among(const std::vector<Complex>& points);

  /// The index of the nearest point; the smallest index among equally near ones.
  int to(Complex point) const;

 private:
  struct Leaf {
    Complex point;
    int index;
  };

  void build(int first, int last);

  /// The middle of each range splits it; in place, without nodes.
  std::vector<Leaf> leaves_;
  std::vector<char> axis_;  ///< axis across which the leaf at this index splits its range
};

}  // namespace spectral_conformal
