#pragma once

#include <vector>

#include "mesh/charts.h"

namespace spectral_conformal {

/// A mirror plane x, y or z = constant through the center of a mesh's bounding box, and what it maps to what.
struct MirrorSymmetry {
  int axis = -1;                  ///< of the plane's normal; -1: no face has a mirror image
  std::vector<int> vertex;        ///< (n_vertices,) the mirror image of each vertex, -1 where there is none
  std::vector<int> face;          ///< (n_faces,) the face on the mirror images of its vertices, -1 where there is none
  std::vector<signed char> side;  ///< (n_vertices,) -1 or 1: the sides of the plane; 0: its own mirror image
};

/// The plane that maps most of the selected faces to selected faces; of equal ones the first axis. Vertices match
/// within `tolerance` of the bounding box's diagonal (by default more than single precision and modeling by hand add
/// to an exact mirror image), and each has at most one image. Coordinates that are not finite match nothing, nor does
/// what lies in a spot where hundreds of vertices are that near to each other. O(n log n) for n corners, in memory
/// O(n). Throws InvalidMesh as build_charts does.
MirrorSymmetry find_mirror_symmetry(const PolygonMesh& mesh, double tolerance = 1e-4);

}  // namespace spectral_conformal
