#include "spectral_conformal/polygon_mesh.h"

#include <string>

#include "spectral_conformal/errors.h"

namespace spectral_conformal {

void validate(const PolygonMesh& mesh) {
  const auto check_size = [](int n, const char* what) {
    if (n <= size_limit) return;
    throw InvalidMesh("The mesh has " + std::to_string(n) + " " + what + "; at most " + std::to_string(size_limit) +
                      " can be numbered. Split it into several meshes.");
  };
  check_size(mesh.n_vertices, "vertices");
  check_size(mesh.n_faces, "faces");
  check_size(mesh.n_corners(), "face corners");
  check_size(mesh.n_seam_edges, "seam edges");
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (mesh.face_offsets[face + 1] < mesh.face_offsets[face]) {
      throw InvalidMesh("face_offsets must not decrease, but they do after face " + std::to_string(face) + ".");
    }
  }
  if (mesh.n_faces > 0 && mesh.face_offsets[0] != 0) throw InvalidMesh("face_offsets must start with 0.");
  for (int c = 0; c < mesh.n_corners(); ++c) {
    const int vertex = mesh.corner_vertices[c];
    if (vertex < 0 || vertex >= mesh.n_vertices) {
      throw InvalidMesh("Corner " + std::to_string(c) + " refers to vertex " + std::to_string(vertex) +
                        ", but there are " + std::to_string(mesh.n_vertices) + " vertices.");
    }
  }
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    for (const int vertex : mesh.seam_edges[i]) {
      if (vertex < 0 || vertex >= mesh.n_vertices) {
        throw InvalidMesh("Seam edge " + std::to_string(i) + " refers to vertex " + std::to_string(vertex) +
                          ", but there are " + std::to_string(mesh.n_vertices) + " vertices.");
      }
    }
  }
}

}  // namespace spectral_conformal
