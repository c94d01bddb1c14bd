#pragma once

#include <vector>

#include "spectral_conformal/plane_motion.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A directed edge of an island's border in the plane.
struct OutlineEdge {
  Complex from;
  Complex to;
};

/// Of a point from the edge.
double squared_distance(Complex p, const OutlineEdge& edge);

/// The region that an island covers: the points about which the edges wind. All faces count as counterclockwise, so
/// flipped and overlapping ones cover their images, too.
struct IslandOutline {
  std::vector<OutlineEdge> edges;
  double area = 0;  ///< of the faces, unsigned; overlaps count twice
};

/// The outlines of `n` islands. points: finite. Face f has the corners face_offsets[f] to face_offsets[f + 1] - 1;
/// corners: the point of each. island_of_face: from 0 to n - 1; other faces are left out. Opposite edges of an island's
/// faces cancel.
std::vector<IslandOutline> island_outlines(const ComplexVector& points, const std::vector<int>& face_offsets,
                                           const std::vector<int>& corners, const std::vector<int>& island_of_face,
                                           int n);

/// Adds the region that `other` covers after the motion, which must be rigid.
void add(IslandOutline& outline, const IslandOutline& other, const PlaneMotion& motion);

/// The convex hull of the outline (convex_hull).
std::vector<Complex> hull_of(const IslandOutline& outline);

/// Whether an outline with these lengths in the two metrics, a cross or a letter L, is along the axes nearer to a
/// rectangle, whose lengths are equal, than to a circle.
bool is_rectilinear(double manhattan, double euclidean);

}  // namespace spectral_conformal
