#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

/// Triangles for drawing the faces of a mesh.
struct FaceTriangles {
  std::vector<std::array<int, 3>> corners;  ///< mesh corners, in the order of the faces
  std::vector<int> face;                    ///< of each triangle
};

/// Triangulates the selected faces as Blender draws them, so that an overlay lies on them: a quad is split along the
/// diagonal of its first corner, unless that lies outside the quad; a larger polygon by triangulate_polygon. Faces with
/// fewer than three corners have no triangle. Uses all cores. Throws InvalidMesh as validate does.
FaceTriangles triangulate_faces(const PolygonMesh& mesh);

}  // namespace spectral_conformal
