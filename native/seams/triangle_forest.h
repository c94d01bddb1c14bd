#pragma once

#include <vector>

#include "geometry/box_tree.h"
#include "geometry/plane_triangle.h"
#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal {

/// Triangles in the plane that others can be tested against, while more come in: trees of sizes that fall by half at
/// least, so that each triangle is placed into a new tree a logarithmic number of times.
class TriangleForest {
 public:
  void add(std::vector<PlaneTriangle>&& triangles);
  /// Whether one of them and `triangle` overlap by more than this fraction of the lesser of their least heights.
  bool overlaps(const PlaneTriangle& triangle, double tolerance) const;
  /// Whether the triangles reach farther along a segment than `widest`, at least its length, within `depth` from it.
  bool is_wider_along(Complex from, Complex to, double depth, double widest) const;
  std::vector<PlaneTriangle> moved(const PlaneMotion& motion) const;

 private:
  struct Tree {
    std::vector<PlaneTriangle> triangles;
    BoxTree boxes;
  };
  std::vector<Tree> trees_;
};

}  // namespace spectral_conformal
