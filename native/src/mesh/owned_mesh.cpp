#include "mesh/owned_mesh.h"

namespace spectral_conformal {

PolygonMesh OwnedMesh::view(const std::vector<std::array<int, 2>>& some_seams) const {
  PolygonMesh mesh;
  mesh.positions = positions.data();
  mesh.n_vertices = static_cast<int>(positions.rows());
  mesh.face_offsets = face_offsets.data();
  mesh.n_faces = n_faces();
  mesh.corner_vertices = corner_vertices.data();
  mesh.seam_edges = some_seams.data();
  mesh.n_seam_edges = static_cast<int>(some_seams.size());
  return mesh;
}

PolygonMesh OwnedMesh::view_on(const PolygonMesh& faces) const {
  PolygonMesh mesh = view();
  mesh.face_offsets = faces.face_offsets;
  mesh.n_faces = faces.n_faces;
  mesh.selected_faces = faces.selected_faces;
  return mesh;
}

}  // namespace spectral_conformal
