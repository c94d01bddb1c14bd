#pragma once

#include <vector>

#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

/// The islands of a map, and its flipped and overlapping faces.
struct MapDefects {
  std::vector<int> island_of_face;  ///< (n_faces,) numbered in the order of their first face; -1 for none
  std::vector<bool> flipped;        ///< (n_faces,)
  std::vector<bool> overlapping;    ///< (n_faces,)
};

/// Finds the defects of a map with one point per corner. Two selected faces lie in one island if they share an edge of
/// exactly two faces and agree on the map of both its ends.
///  - Flipped: a triangle of the face is wound against the majority, by area in the map, of its island (flips.h). The
///    island is oriented first: an island mirrored as a whole, or wound inconsistently in 3D, has no flipped faces for
///    that reason. Polygons are triangulated in the map, so a concave one is not flipped and a self-intersecting one
///    is. A polygon of five or more corners that only touches itself may count as self-intersecting. Quads are split by
///    mapped_triangulation.
///  - Overlapping: covers part of another face of its island, or, with `between_islands`, of any island.
/// UVs are assumed to be in single precision: contacts and triangles thinner than 2.5e-7 of their coordinates do not
/// count, so collapsed faces are neither flipped nor overlapping. Among faces with the same vertices and the same map
/// only the first is tested. Faces with fewer than three distinct corners are not tested.
///
/// mesh: seams and positions are not used. corner_uv: (n_corners, 2), finite at selected faces. Throws InvalidMesh as
/// build_charts does, and where corner_uv is not finite.
MapDefects find_map_defects(const PolygonMesh& mesh, const double* corner_uv, bool between_islands);

}  // namespace spectral_conformal
