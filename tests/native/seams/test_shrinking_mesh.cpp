#include <doctest/doctest.h>

#include <vector>

#include "meshes.h"
#include "seams/shrinking_mesh.h"

namespace spectral_conformal::test {
namespace {

Piece piece_of(const Mesh& mesh) { return MirroredPieces::of(mesh.view()).pieces.front(); }

/// The neighbors that a vertex can be merged into.
std::vector<int> targets(const ShrinkingMesh& mesh, int v) {
  std::vector<int> neighbors;
  std::vector<int> others;
  std::vector<int> result;
  mesh.collect_neighbors(v, neighbors);
  if (!mesh.is_simple_fan(v, neighbors)) return result;
  for (const int w : neighbors) {
    if ((result.empty() || result.back() != w) && mesh.can_merge(v, w, neighbors, others)) result.push_back(w);
  }
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("shrinking_mesh");

TEST_CASE("inner vertices merge into any neighbor, those of the boundary along it") {
  const Piece piece = piece_of(quad_grid(4, 4));
  const ShrinkingMesh mesh(piece);
  CHECK(targets(mesh, 12) == std::vector<int>{7, 11, 13, 17});
  CHECK(targets(mesh, 2) == std::vector<int>{1, 3});
  CHECK(mesh.boundary().size() == 16);
}

TEST_CASE("a merge that would change the topology is refused") {
  Mesh tetrahedron;
  tetrahedron.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& face : {std::vector<int>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) tetrahedron.add(face);
  const Piece piece = piece_of(tetrahedron);
  const ShrinkingMesh mesh(piece);
  for (int v = 0; v < 4; ++v) CHECK(targets(mesh, v).empty());
}

TEST_CASE("the faces of a vertex follow its merge") {
  const Piece piece = piece_of(quad_grid(4, 4));
  ShrinkingMesh mesh(piece);
  mesh.merge(12, 13);
  CHECK(mesh.n_vertices() == 24);
  CHECK_FALSE(mesh.is_left(12));
  CHECK(mesh.roots()[12] == 13);
  CHECK(mesh.faces_of(13).size() == 6);
}

TEST_CASE("vertices of seams stay") {
  Mesh slit = quad_grid(4, 4);
  slit.seams = {{11, 12}, {12, 13}};
  const Piece piece = piece_of(slit);
  const ShrinkingMesh mesh(piece);
  for (const int v : {11, 12, 13}) CHECK(mesh.stays(v));
  CHECK_FALSE(mesh.stays(7));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
