#pragma once

#include <vector>

#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

/// The role of a face of a mesh.
enum class FaceState : char {
  unselected,
  used,
  degenerate,  ///< fewer than three distinct vertices, or one twice in a row
  duplicate    ///< a face of lower index has the same vertices
};

/// The half-edges of the selected faces of a polygon mesh. Half-edge c runs from the vertex of corner c to that of the
/// next corner of the same face. Its twin is the half-edge on the other side of a non-seam edge of exactly two used
/// faces; if faces are wound inconsistently, twins may run in the same direction.
class HalfEdges {
 public:
  /// The arrays of `mesh` must outlive this object. Precondition: validate(mesh) passes.
  static HalfEdges of(const PolygonMesh& mesh);

  int n_corners() const { return static_cast<int>(face_of_corner_.size()); }
  int face(int corner) const { return face_of_corner_[corner]; }
  int next(int corner) const {
    const int face = face_of_corner_[corner];
    return corner + 1 == mesh_.face_offsets[face + 1] ? mesh_.face_offsets[face] : corner + 1;
  }
  int from(int corner) const { return mesh_.corner_vertices[corner]; }
  int to(int corner) const { return mesh_.corner_vertices[next(corner)]; }
  /// The twin of half-edge `corner`, -1 on the boundary and outside used faces.
  int twin(int corner) const { return twin_[corner]; }
  /// Whether a half-edge runs opposite to its twin, as on consistently wound faces. Precondition: it has a twin.
  bool is_opposed(int corner) const { return from(corner) == to(twin_[corner]); }

  FaceState state(int face) const { return state_[face]; }
  bool is_used(int face) const { return state_[face] == FaceState::used; }
  /// For a duplicate, the used face with the same vertices; otherwise -1.
  int original(int face) const { return original_.empty() ? -1 : original_[face]; }
  /// Edges of three or more used faces; their half-edges have no twins.
  int non_manifold_edges() const { return non_manifold_edges_; }

 private:
  void classify_faces();
  void find_twins();
  void mark_duplicates(std::vector<int> candidates);

  PolygonMesh mesh_;
  std::vector<int> face_of_corner_;
  std::vector<FaceState> state_;
  std::vector<int> original_;  ///< empty without duplicates
  std::vector<int> twin_;
  int non_manifold_edges_ = 0;
};

}  // namespace spectral_conformal
