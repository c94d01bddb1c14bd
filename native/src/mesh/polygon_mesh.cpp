#include "spectral_conformal/polygon_mesh.h"

#include "spectral_conformal/errors.h"

namespace spectral_conformal {

void validate(const PolygonMesh& mesh) {
  const auto check_size = [](int n, Rejection too_many) {
    if (n > size_limit) throw InvalidMesh(too_many, n, 0, size_limit);
  };
  check_size(mesh.n_vertices, Rejection::too_many_vertices);
  check_size(mesh.n_faces, Rejection::too_many_faces);
  check_size(mesh.n_corners(), Rejection::too_many_corners);
  check_size(mesh.n_seam_edges, Rejection::too_many_seam_edges);
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (mesh.face_offsets[face + 1] < mesh.face_offsets[face]) throw InvalidMesh(Rejection::offsets_decrease, face);
  }
  if (mesh.n_faces > 0 && mesh.face_offsets[0] != 0) throw InvalidMesh(Rejection::offsets_not_from_zero);
  for (int c = 0; c < mesh.n_corners(); ++c) {
    const int vertex = mesh.corner_vertices[c];
    if (vertex < 0 || vertex >= mesh.n_vertices) {
      throw InvalidMesh(Rejection::corner_of_no_vertex, c, vertex, mesh.n_vertices);
    }
  }
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    for (const int vertex : mesh.seam_edges[i]) {
      if (vertex < 0 || vertex >= mesh.n_vertices) {
        throw InvalidMesh(Rejection::seam_of_no_vertex, i, vertex, mesh.n_vertices);
      }
    }
  }
}

}  // namespace spectral_conformal
