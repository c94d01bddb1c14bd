#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/face_triangles.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("face_triangles");

TEST_CASE("every face is covered once, whatever its corners") {
  Mesh mesh({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}, {1, -1, 0}},
            {{0, 1, 2, 3, 4}, {0, 5, 1}, {3, 4, 0, 1}, {4, 0, 1, 3}, {0, 1, 2, 4}});
  mesh.add({0, 1});
  const std::vector<double> area = {2.5, 1, 1.5, 1.5, 4, 0};
  const FaceTriangles triangles = triangulate_faces(mesh.view());
  REQUIRE(triangles.corners.size() == 3 + 1 + 2 + 2 + 2);
  std::vector<double> covered(area.size(), 0);
  for (std::size_t t = 0; t < triangles.corners.size(); ++t) {
    const auto& [a, b, c] = triangles.corners[t];
    const int face = triangles.face[t];
    for (const int corner : {a, b, c}) {
      CHECK(corner >= mesh.offsets[face]);
      CHECK(corner < mesh.offsets[face + 1]);
    }
    const Eigen::Vector3d& p = mesh.points[mesh.corners[a]];
    const double z = (mesh.points[mesh.corners[b]] - p).cross(mesh.points[mesh.corners[c]] - p).z();
    CHECK(z > 0);
    covered[face] += 0.5 * z;
  }
  for (std::size_t face = 0; face < area.size(); ++face) CHECK(covered[face] == doctest::Approx(area[face]));
}

TEST_CASE("a convex quad is split at its first corner") {
  const FaceTriangles triangles = triangulate_faces(quad_grid(2, 1).view());
  REQUIRE(triangles.corners.size() == 4);
  CHECK(triangles.corners[0] == std::array<int, 3>{0, 1, 2});
  CHECK(triangles.corners[1] == std::array<int, 3>{0, 2, 3});
  CHECK(triangles.corners[3] == std::array<int, 3>{4, 6, 7});
}

TEST_CASE("faces that are not selected have none, and indices are checked") {
  const Mesh mesh = quad_grid(2, 2);
  PolygonMesh view = mesh.view();
  const bool selected[] = {false, true, false, false};
  view.selected_faces = selected;
  CHECK(triangulate_faces(view).face == std::vector<int>{1, 1});
  view.n_vertices = 3;
  CHECK_THROWS_AS(triangulate_faces(view), InvalidMesh);
  CHECK(triangulate_faces(PolygonMesh{}).face.empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
