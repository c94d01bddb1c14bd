#pragma once

#include <array>
#include <vector>

#include "mesh/charts.h"

namespace spectral_conformal {

/// The selected faces of a mesh, and the vertices that they use, in an order that their shape alone decides, so that
/// what is computed from them does not depend on how the caller's arrays number them. Vertices are in the order of
/// their coordinates (x, then y, then z), those at one position in the order of the faces around them, refined until
/// nothing tells them apart any more (color refinement; Weisfeiler and Leman 1968). Faces begin with their first
/// vertex, keep their winding, and are in the order of their vertices.
class CanonicalMesh {
 public:
  /// Coordinates that are not finite come last. Throws InvalidMesh as validate does.
  explicit CanonicalMesh(const PolygonMesh& mesh);

  /// Valid while this object lives. All of its faces are selected; its seams are those between its vertices, each once.
  PolygonMesh view() const;
  /// (V,) the vertex of the given mesh.
  const std::vector<int>& vertices() const { return vertices_; }

 private:
  Positions positions_;
  std::vector<int> face_offsets_{0};
  std::vector<int> corner_vertices_;
  std::vector<std::array<int, 2>> seams_;
  std::vector<int> vertices_;
};

}  // namespace spectral_conformal
