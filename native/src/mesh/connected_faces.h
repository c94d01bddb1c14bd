#pragma once

#include <vector>

namespace spectral_conformal {

/// The component of each face (F,), faces that share a vertex being connected; numbered in the order of their first
/// faces, -1 for a face without corners. face_offsets: (F + 1,), corner_vertices: as in PolygonMesh.
std::vector<int> connected_faces(const int* face_offsets, const int* corner_vertices, int n_faces, int n_vertices);

}  // namespace spectral_conformal
