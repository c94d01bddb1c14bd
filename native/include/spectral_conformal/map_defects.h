#pragma once

#include <vector>

#include "mesh/charts.h"

namespace spectral_conformal {

/// Faces of a map that lie the wrong way round or on others.
struct MapDefects {
  std::vector<bool> flipped;      ///< (n_faces,)
  std::vector<bool> overlapping;  ///< (n_faces,)
};

/// Looks for defects in a map with one point per corner. Its islands are the parts of the selected faces that are
/// connected over edges of exactly two faces that agree on the map of both ends.
///  - Flipped: a triangle of the face is wound against the majority, by area in the map, of its island, the island
///  being
///    oriented first: an island that is mirrored as a whole has no flipped faces, nor has one whose faces are wound
///    inconsistently in 3D. Polygons are triangulated in the map, so that a concave one is not flipped; one that
///    crosses itself is. A polygon of five corners or more that only touches itself may be taken for one that crosses
///    itself.
///  - Overlapping: covers part of another face of its island, or with `between_islands` of any.
/// Single precision is assumed: contacts and triangles of a depth below 2.5e-7 of their coordinates do not count, so
/// that collapsed faces are neither flipped nor overlapping. Of several faces on the same vertices with the same map
/// the first is looked at only; faces with fewer than three different corners are not looked at.
///
/// mesh: seams and positions are not looked at; corner_uv (n_corners, 2), finite at selected faces.
/// Throws InvalidMesh as build_charts does, and where corner_uv is not finite.
MapDefects find_map_defects(const PolygonMesh& mesh, const double* corner_uv, bool between_islands);

}  // namespace spectral_conformal
