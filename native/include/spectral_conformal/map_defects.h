#pragma once

#include <vector>

#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

/// The islands of a map, and its faces that are flipped or cover others.
struct MapDefects {
  std::vector<int> island_of_face;  ///< (n_faces,) numbered in the order of their first face; -1 for faces in none
  std::vector<bool> flipped;        ///< (n_faces,)
  std::vector<bool> overlapping;    ///< (n_faces,)
};

/// Finds the defects of a map with one point per corner. Its islands are the sets of selected faces that are connected
/// over edges of exactly two faces that agree on the map of both ends.
///  - Flipped: a triangle of the face is wound against the majority, by area in the map, of its island (flips.h). The
///    island is oriented first: one that is mirrored as a whole has no flipped faces, nor has one whose faces are wound
///    inconsistently in 3D. Polygons are triangulated in the map, so that a concave one is not flipped; one that
///    crosses itself is. A polygon of five corners or more that only touches itself may be taken for one that crosses
///    itself. Quads are split by mapped_triangulation.
///  - Overlapping: covers a part of another face of its island, or with `between_islands` of any.
/// UVs are assumed to be in single precision: contacts and triangles of a depth below 2.5e-7 of their coordinates do
/// not count, so that collapsed faces are neither flipped nor overlapping. Of several faces on the same vertices with
/// the same map only the first is tested; faces with fewer than three different corners are not tested.
///
/// mesh: seams and positions are not used. corner_uv (n_corners, 2), finite at selected faces.
/// Throws InvalidMesh as build_charts does, and where corner_uv is not finite.
MapDefects find_map_defects(const PolygonMesh& mesh, const double* corner_uv, bool between_islands);

}  // namespace spectral_conformal
