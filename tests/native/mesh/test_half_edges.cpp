#include <doctest/doctest.h>

#include "mesh/half_edges.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

int n_boundary(const HalfEdges& half_edges) {
  int count = 0;
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    if (half_edges.is_used(half_edges.face(c)) && half_edges.twin(c) < 0) ++count;
  }
  return count;
}

}  // namespace

TEST_SUITE_BEGIN("half_edges");

TEST_CASE("twins lie on the two sides of an edge, whichever way their faces are wound") {
  for (const bool mixed : {false, true}) {
    Mesh mesh = quad_grid(4, 3);
    if (mixed) mesh.reverse(5);
    const HalfEdges half_edges = HalfEdges::of(mesh.view());
    int against = 0;
    for (int c = 0; c < half_edges.n_corners(); ++c) {
      CHECK(half_edges.face(half_edges.next(c)) == half_edges.face(c));
      const int twin = half_edges.twin(c);
      if (twin < 0) continue;
      CHECK(half_edges.twin(twin) == c);
      CHECK(half_edges.face(twin) != half_edges.face(c));
      const bool opposed = half_edges.is_opposed(c);
      CHECK(half_edges.from(c) == (opposed ? half_edges.to(twin) : half_edges.from(twin)));
      CHECK(half_edges.to(c) == (opposed ? half_edges.from(twin) : half_edges.to(twin)));
      against += opposed ? 0 : 1;
    }
    CHECK(n_boundary(half_edges) == 14);
    CHECK(against == (mixed ? 8 : 0));
  }
}

TEST_CASE("seams, edges of three faces, degenerate and unselected faces have no twins") {
  Mesh seam = quad_grid(2, 1);
  seam.seams = {{4, 1}};
  CHECK(n_boundary(HalfEdges::of(seam.view())) == 8);
  const Mesh fin({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CHECK(HalfEdges::of(fin.view()).non_manifold_edges() == 1);
  CHECK(n_boundary(HalfEdges::of(fin.view())) == 9);
  Mesh degenerate = quad_grid(1, 1);
  degenerate.add({0, 1, 1});
  degenerate.add({0, 1, 0, 1});
  const HalfEdges of_degenerate = HalfEdges::of(degenerate.view());
  CHECK(of_degenerate.state(1) == FaceState::degenerate);
  CHECK(of_degenerate.state(2) == FaceState::degenerate);
  CHECK(n_boundary(of_degenerate) == 4);
  const Mesh grid = quad_grid(3, 1);
  const bool selected[] = {true, false, true};
  PolygonMesh view = grid.view();
  view.selected_faces = selected;
  const HalfEdges of_selected = HalfEdges::of(view);
  CHECK(of_selected.state(1) == FaceState::unselected);
  CHECK(n_boundary(of_selected) == 8);
}

TEST_CASE("duplicates name the face that is kept, and take no part in edges") {
  Mesh mesh = quad_grid(2, 1);
  mesh.add({4, 3, 0, 1});  // the first face again, the other way around
  mesh.add({1, 4, 3, 0});
  const HalfEdges half_edges = HalfEdges::of(mesh.view());
  CHECK(half_edges.state(0) == FaceState::used);
  for (const int face : {2, 3}) {
    CHECK(half_edges.state(face) == FaceState::duplicate);
    CHECK(half_edges.original(face) == 0);
  }
  CHECK(half_edges.original(1) == -1);
  CHECK(half_edges.non_manifold_edges() == 0);
  CHECK(n_boundary(half_edges) == 6);
  const Mesh pillow({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  CHECK(HalfEdges::of(pillow.view()).state(1) == FaceState::duplicate);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
