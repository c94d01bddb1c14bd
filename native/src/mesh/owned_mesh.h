#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A polygon mesh with arrays of its own. Its views are valid while it is neither changed nor destroyed.
struct OwnedMesh {
  Positions positions;                    ///< (V, 3)
  std::vector<int> face_offsets{0};       ///< (F + 1,)
  std::vector<int> corner_vertices;       ///< (C,)
  std::vector<std::array<int, 2>> seams;  ///< pairs of vertices

  int n_faces() const { return static_cast<int>(face_offsets.size()) - 1; }
  /// The corners added since the last face become one.
  void end_face() { face_offsets.push_back(static_cast<int>(corner_vertices.size())); }

  PolygonMesh view() const { return view(seams); }
  /// With other seams, which must outlive the view, too.
  PolygonMesh view(const std::vector<std::array<int, 2>>& some_seams) const;
  /// With the faces of another mesh, of as many corners, instead of its own.
  PolygonMesh view_on(const PolygonMesh& faces) const;
};

}  // namespace spectral_conformal
