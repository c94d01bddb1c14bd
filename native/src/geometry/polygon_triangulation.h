#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The triangles of one polygon, as corner numbers, and their weights (quad_splits.h).
struct PolygonTriangulation {
  std::vector<std::array<int, 3>> triangles;
  std::vector<TriangleWeight> triangle_weights;
  bool simple = true;  ///< false: the projected polygon crosses itself, and a fan replaces its triangulation
};

/// Triangulates a polygon by its geometry, independently of its first corner.
///  - Triangle: itself.
///  - Quad: both diagonal splits (the four triangles of quad_splits) at half weight if it is convex as seen along the
///    cross product of its diagonals, so that a symmetric quad mesh has a symmetric energy; otherwise the one split
///    that stays inside.
///  - More corners: the constrained Delaunay triangulation of its projection along Newell's normal (CGAL). Its outline
///    may touch itself and run along itself, as bridges to holes do, with distinct or repeated vertices: coincident
///    corners are told apart. If an edge passes through another corner, or the outline has spikes, ears are clipped
///    instead (clip_ears), some of them without area.
/// corners: (n, 3), n >= 3, in order. Polygons that cross themselves or are collinear get a fan around the corner
/// nearest to their centroid. Yields n - 2 triangles, except for both splits; O(n log n), except for many ears.
void triangulate_polygon(const Eigen::Ref<const Positions>& corners, PolygonTriangulation& result);

}  // namespace spectral_conformal
