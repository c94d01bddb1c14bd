#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Triangles of one polygon, as corner numbers, and the weight with which each counts (quad_splits.h).
struct PolygonTriangulation {
  std::vector<std::array<int, 3>> triangles;
  std::vector<TriangleWeight> triangle_weights;
  bool simple = true;  ///< false: the projected polygon crosses itself, and a fan stands in
};

/// Triangulates a polygon by its geometry, whatever corner comes first.
///  - Triangle: itself.
///  - Quad: both diagonal splits at half weight when it is convex as seen along the cross product of its diagonals, so
///    that a symmetric quad mesh has a symmetric energy (the four triangles of quad_splits); otherwise the one split
///    that stays inside.
///  - More corners: the constrained Delaunay triangulation of its projection along Newell's normal (CGAL). Its outline
///    may touch itself and run along itself, as bridges to holes do, with vertices of their own or repeated ones:
///    corners at one place are told apart. Where an edge passes through another corner, or the outline has spikes, ears
///    are clipped instead (clip_ears), some of them without area.
/// corners (n, 3), n >= 3, in order. Polygons that cross themselves, or lie on one line, get a fan around the corner
/// nearest to their centroid. n - 2 triangles in any case but that of both splits; n log n but for many ears.
void triangulate_polygon(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result);

}  // namespace spectral_conformal
