#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

/// Triangles to draw the faces of a mesh by.
struct FaceTriangles {
  std::vector<std::array<int, 3>> corners;  ///< of the mesh, in the order of the faces
  std::vector<int> face;                    ///< of each triangle
};

/// Triangulates the selected faces as Blender draws them, so that what is drawn over them lies on them: a quad along
/// the diagonal of its first corner, unless that lies outside of it; of more corners by triangulate_polygon. Faces with
/// fewer than three corners have no triangle. In as many threads as there are cores.
/// Throws InvalidMesh as validate does.
FaceTriangles triangulate_faces(const PolygonMesh& mesh);

}  // namespace spectral_conformal
