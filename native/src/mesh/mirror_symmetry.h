#pragma once

#include <vector>

#include "mesh/charts.h"

namespace spectral_conformal {

/// A mirror plane x, y or z = constant through the center of a mesh's bounding box, and its matching.
struct MirrorSymmetry {
  int axis = -1;                  ///< axis of the plane's normal; -1: no face has a mirror image
  std::vector<int> vertex;        ///< (n_vertices,) the mirror image of each vertex, or -1
  std::vector<int> face;          ///< (n_faces,) the face on the mirror images of its vertices, or -1
  std::vector<signed char> side;  ///< (n_vertices,) -1 or 1: the sides of the plane; 0: its own mirror image
};

/// The plane that maps the most selected faces to selected faces; ties go to the first axis. Vertices match within
/// `tolerance` times the diagonal of the bounding box, and each has at most one image. The default exceeds the errors
/// of single precision and of modeling by hand. Non-finite vertices match nothing; neither do clusters of hundreds of
/// vertices within the tolerance. O(n log n) time for n corners, O(n) memory. Throws InvalidMesh as build_charts does.
MirrorSymmetry find_mirror_symmetry(const PolygonMesh& mesh, double tolerance = 1e-4);

}  // namespace spectral_conformal
