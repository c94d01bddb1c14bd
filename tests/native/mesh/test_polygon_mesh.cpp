#include <doctest/doctest.h>

#include "mesh/charts.h"
#include "meshes.h"
#include "refusal.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("polygon_mesh");

TEST_CASE("corners are counted, and without a selection every face is selected") {
  Mesh mesh = quad_grid(2, 1);
  mesh.add({0, 1, 2});
  PolygonMesh view = mesh.view();
  CHECK(view.n_corners() == 11);
  CHECK(view.n_corners(1) == 4);
  CHECK(view.n_corners(2) == 3);
  CHECK(PolygonMesh{}.n_corners() == 0);
  CHECK(view.is_selected(1));
  const bool selected[] = {true, false, true};
  view.selected_faces = selected;
  CHECK_FALSE(view.is_selected(1));
}

TEST_CASE("arrays that do not describe a mesh are refused") {
  const auto refused = [](auto&& spoil) {
    Mesh mesh = quad_grid(2, 2);
    mesh.seams = {{0, 1}};
    spoil(mesh);
    CHECK_THROWS_AS(validate(mesh.view()), InvalidMesh);
    CHECK_THROWS_AS(build_charts(mesh.view()), InvalidMesh);
  };
  refused([](Mesh& mesh) { mesh.offsets[2] = 3; });
  refused([](Mesh& mesh) { mesh.offsets[0] = 1; });
  refused([](Mesh& mesh) { mesh.offsets[0] = -1; });
  refused([](Mesh& mesh) { mesh.corners[5] = 9; });
  refused([](Mesh& mesh) { mesh.corners[5] = -1; });
  refused([](Mesh& mesh) { mesh.seams[0] = {0, 9}; });
  refused([](Mesh& mesh) { mesh.seams[0] = {-1, 0}; });
}

TEST_CASE("a mesh with more of anything than can be numbered is refused before its arrays are read") {
  const std::vector<int> offsets{0, size_limit + 1};
  const auto refused = [](const PolygonMesh& mesh, Rejection reason) {
    const Step step = refusal([&] { validate(mesh); });
    return step.reason == reason && step.count == size_limit + 1 && step.limit == size_limit;
  };
  PolygonMesh mesh;
  mesh.face_offsets = offsets.data();
  mesh.n_faces = 1;
  CHECK(refused(mesh, Rejection::too_many_corners));
  mesh.n_faces = size_limit + 1;
  CHECK(refused(mesh, Rejection::too_many_faces));
  mesh.n_faces = 0;
  mesh.n_vertices = size_limit + 1;
  CHECK(refused(mesh, Rejection::too_many_vertices));
  mesh.n_vertices = 3;
  mesh.n_seam_edges = size_limit + 1;
  CHECK(refused(mesh, Rejection::too_many_seam_edges));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
