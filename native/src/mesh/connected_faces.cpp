#include "mesh/connected_faces.h"

#include <cstddef>

#include "concurrency/cancellation_scope.h"
#include "graph/disjoint_sets.h"

namespace spectral_conformal {

std::vector<int> connected_faces(const int* face_offsets, const int* corner_vertices, int n_faces, int n_vertices) {
  DisjointSets sets(n_vertices);
  for_each_polled(n_faces, [&](int face) {
    for (int c = face_offsets[face] + 1; c < face_offsets[face + 1]; ++c) {
      sets.unite(corner_vertices[c - 1], corner_vertices[c]);
    }
  });
  std::vector<int> number(static_cast<std::size_t>(n_vertices), -1);
  std::vector<int> result(static_cast<std::size_t>(n_faces), -1);
  int n = 0;
  for_each_polled(n_faces, [&](int face) {
    if (face_offsets[face] == face_offsets[face + 1]) return;
    int& own = number[static_cast<std::size_t>(sets.find(corner_vertices[face_offsets[face]]))];
    if (own < 0) own = n++;
    result[static_cast<std::size_t>(face)] = own;
  });
  return result;
}

}  // namespace spectral_conformal
