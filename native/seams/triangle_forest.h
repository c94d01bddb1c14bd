#pragma once

#include <vector>

#include "geometry/box_tree.h"
#include "geometry/plane_triangle.h"
#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal {

/// A growing set of triangles in the plane, with tests of others against it. Each of its trees is at most half as large
/// as the one before, so a triangle moves to a new tree only O(log n) times.
class TriangleForest {
 public:
  void add(std::vector<PlaneTriangle>&& triangles);
  /// Whether one of them overlaps `triangle` by more than `tolerance` times the smaller of their least heights.
  bool overlaps(const PlaneTriangle& triangle, double tolerance) const;
  /// Whether the triangles within `depth` of a segment's line are together wider than `widest` along it. `widest` is at
  /// least the segment's length.
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
