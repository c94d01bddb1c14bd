#include <doctest/doctest.h>

#include "mesh/owned_mesh.h"

namespace spectral_conformal::test {
namespace {

/// A triangle and a quad on five points.
OwnedMesh two_faces() {
  OwnedMesh mesh;
  mesh.positions = Positions::Random(5, 3);
  mesh.seams = {{1, 2}};
  for (const std::vector<int>& face : {std::vector<int>{0, 1, 2}, {2, 1, 3, 4}}) {
    mesh.corner_vertices.insert(mesh.corner_vertices.end(), face.begin(), face.end());
    mesh.end_face();
  }
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("owned_mesh");

TEST_CASE("a view is a valid mesh of the faces that were ended") {
  CHECK(OwnedMesh().view().n_faces == 0);
  const OwnedMesh mesh = two_faces();
  CHECK(mesh.n_faces() == 2);
  const PolygonMesh view = mesh.view();
  validate(view);
  CHECK(view.n_corners(0) == 3);
  CHECK(view.n_corners(1) == 4);
  CHECK(view.n_vertices == 5);
  CHECK(view.position(3)[2] == mesh.positions(3, 2));
  CHECK(view.n_seam_edges == 1);
  const std::vector<std::array<int, 2>> others{{0, 1}, {3, 4}};
  CHECK(mesh.view(others).n_seam_edges == 2);
  CHECK(mesh.view(others).corner_vertices == view.corner_vertices);
}

TEST_CASE("a view may have the faces of another mesh, and which are selected") {
  const OwnedMesh mesh = two_faces();
  const int offsets[] = {0, 4, 7};
  const bool selected[] = {true, false};
  PolygonMesh faces;
  faces.face_offsets = offsets;
  faces.n_faces = 2;
  faces.selected_faces = selected;
  const PolygonMesh view = mesh.view_on(faces);
  validate(view);
  CHECK(view.n_corners(0) == 4);
  CHECK(view.is_selected(0));
  CHECK_FALSE(view.is_selected(1));
  CHECK(view.corner_vertices == mesh.corner_vertices.data());
  CHECK(view.positions == mesh.positions.data());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
