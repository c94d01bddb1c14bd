#pragma once

#include <array>
#include <limits>

namespace spectral_conformal {

/// A polygon mesh in the caller's arrays. It owns nothing. The arrays must not change while the mesh is in use: some
/// algorithms count in one pass and fill in the next.
struct PolygonMesh {
  const double* positions = nullptr;  ///< (n_vertices, 3)
  int n_vertices = 0;
  const int* face_offsets = nullptr;  ///< (n_faces + 1,): corners of face f are [face_offsets[f], face_offsets[f+1])
  int n_faces = 0;
  const int* corner_vertices = nullptr;            ///< (face_offsets[n_faces],)
  const bool* selected_faces = nullptr;            ///< (n_faces,) or null for all
  const std::array<int, 2>* seam_edges = nullptr;  ///< (n_seam_edges,) vertex pairs in any order
  int n_seam_edges = 0;

  const double* position(int vertex) const { return positions + 3 * static_cast<std::size_t>(vertex); }
  int n_corners() const { return n_faces == 0 ? 0 : face_offsets[n_faces]; }
  int n_corners(int face) const { return face_offsets[face + 1] - face_offsets[face]; }
  bool is_selected(int face) const { return selected_faces == nullptr || selected_faces[face]; }
};

/// Calls visit(corner, face) for the corners of the selected faces.
template <class Visit>
void for_each_selected_corner(const PolygonMesh& mesh, const Visit& visit) {
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) visit(c, face);
  }
}

/// Calls visit(corner, next, face) for the sides of the selected faces, each from a corner to the next one.
template <class Visit>
void for_each_side(const PolygonMesh& mesh, const Visit& visit) {
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    const int first = mesh.face_offsets[face];
    const int last = mesh.face_offsets[face + 1] - 1;
    for (int c = first; c <= last; ++c) visit(c, c == last ? first : c + 1, face);
  }
}

/// The largest number of vertices, faces, corners or seam edges for which an int can also number what derives from
/// them: a corner yields up to two triangles (one virtual), hence six half-edges and six matrix entries.
constexpr int size_limit = std::numeric_limits<int>::max() / 8;

/// Throws InvalidMesh if the mesh exceeds size_limit, offsets decrease or an index is out of range.
void validate(const PolygonMesh& mesh);

}  // namespace spectral_conformal
