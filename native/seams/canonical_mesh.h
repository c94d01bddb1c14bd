#pragma once

#include <vector>

#include "mesh/owned_mesh.h"

namespace spectral_conformal {

/// The selected faces of a mesh and their vertices, in an order that depends only on the shape. Results then do not
/// depend on the numbering in the caller's arrays. Vertices are sorted by coordinates (x, then y, then z), which are
/// rounded to a grid relative to the extent (relative_grid.h); coincident ones by the faces around them, where these
/// differ (color refinement; Weisfeiler and Leman 1968), then by the exact coordinates. Faces start at
/// their first vertex; if it occurs several times, where its successor comes first. They keep their winding and are
/// sorted by their vertices. Each seam edge between two of the vertices appears once.
struct CanonicalMesh : OwnedMesh {
  /// NaN comes last. Throws InvalidMesh as validate does, and Cancelled.
  static CanonicalMesh of(const PolygonMesh& mesh);

  std::vector<int> vertices;  ///< (V,) the index of each vertex in the given mesh
};

}  // namespace spectral_conformal
