#pragma once

#include <array>
#include <vector>

#include "mesh/charts.h"

namespace spectral_conformal {

/// The selected faces of a mesh and their vertices, in an order that depends only on the shape. Results then do not
/// depend on the numbering in the caller's arrays. Vertices are sorted by coordinates (x, then y, then z), which are
/// rounded to a grid relative to the extent (relative_grid.h); coincident ones by the faces around them, where these
/// differ (color refinement; Weisfeiler and Leman 1968), then by the exact coordinates. Faces start at
/// their first vertex; if it occurs several times, where its successor comes first. They keep their winding and are
/// sorted by their vertices.
class CanonicalMesh {
 public:
  /// NaN comes last. Throws InvalidMesh as validate does, and Cancelled.
  static CanonicalMesh of(const PolygonMesh& mesh);

  /// Valid while this object lives. All faces are selected. Each seam edge between two of the vertices appears once.
  PolygonMesh view() const;
  /// (V,) the index of each vertex in the given mesh.
  const std::vector<int>& vertices() const { return vertices_; }

 private:
  Positions positions_;
  std::vector<int> face_offsets_{0};
  std::vector<int> corner_vertices_;
  std::vector<std::array<int, 2>> seams_;
  std::vector<int> vertices_;
};

}  // namespace spectral_conformal
