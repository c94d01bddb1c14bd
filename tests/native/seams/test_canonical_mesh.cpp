#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "meshes.h"
#include "seams/canonical_mesh.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

std::vector<int> shuffled_numbers(int n, unsigned seed) {
  std::vector<int> result(static_cast<std::size_t>(n));
  std::iota(result.begin(), result.end(), 0);
  std::mt19937 random(seed);
  std::shuffle(result.begin(), result.end(), random);
  return result;
}

/// The same shape with other numbers of vertices and faces, and other first corners.
Mesh renumbered(const Mesh& mesh, unsigned seed) {
  const std::vector<int> vertex = shuffled_numbers(static_cast<int>(mesh.points.size()), seed);
  Mesh result;
  result.points.resize(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) result.points[vertex[v]] = mesh.points[v];
  for (const int face : shuffled_numbers(mesh.n_faces(), seed + 1)) {
    std::vector<int> corners;
    for (int c = mesh.offsets[face]; c < mesh.offsets[face + 1]; ++c) corners.push_back(vertex[mesh.corners[c]]);
    std::rotate(corners.begin(), corners.begin() + face % static_cast<int>(corners.size()), corners.end());
    result.add(corners);
  }
  for (auto seam = mesh.seams.rbegin(); seam != mesh.seams.rend(); ++seam) {
    result.seams.push_back({vertex[(*seam)[1]], vertex[(*seam)[0]]});
  }
  return result;
}

void check_equal(const PolygonMesh& a, const PolygonMesh& b) {
  REQUIRE(a.n_vertices == b.n_vertices);
  REQUIRE(a.n_faces == b.n_faces);
  REQUIRE(a.n_seam_edges == b.n_seam_edges);
  CHECK(std::equal(a.positions, a.positions + 3 * a.n_vertices, b.positions));
  CHECK(std::equal(a.face_offsets, a.face_offsets + a.n_faces + 1, b.face_offsets));
  CHECK(std::equal(a.corner_vertices, a.corner_vertices + a.n_corners(), b.corner_vertices));
  CHECK(std::equal(a.seam_edges, a.seam_edges + a.n_seam_edges, b.seam_edges));
}

}  // namespace

TEST_SUITE_BEGIN("canonical_mesh");

TEST_CASE("every numbering of a mesh gives the same arrays") {
  Mesh doubled = quad_grid(4, 3);  // two sheets on the same positions, one without its last face
  Mesh sheet = doubled;
  sheet.corners.resize(sheet.corners.size() - 4);
  sheet.offsets.pop_back();
  doubled.append(sheet);
  Mesh seamed = torus(8, 6);
  seamed.seams = {{0, 1}, {1, 2}};
  for (const Mesh& mesh : {bumpy_grid(5, 4), sphere(4), tetrahedron(), doubled, seamed}) {
    const CanonicalMesh canonical = CanonicalMesh::of(mesh.view());
    for (const unsigned seed : {1U, 2U, 3U}) {
      const Mesh other = renumbered(mesh, seed);
      const CanonicalMesh again = CanonicalMesh::of(other.view());
      check_equal(canonical.view(), again.view());
      for (std::size_t v = 0; v < again.vertices.size(); ++v) {
        CHECK(other.points[again.vertices[v]] == mesh.points[canonical.vertices[v]]);
      }
    }
  }
}

TEST_CASE("it is the given mesh, renumbered") {
  const Mesh mesh = bumpy_grid(3, 3);
  const CanonicalMesh canonical = CanonicalMesh::of(mesh.view());
  CHECK(canonical.view().n_faces == mesh.n_faces());
  std::vector<std::vector<int>> expected, found;
  const auto rotated = [](std::vector<int> face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
  };
  for (int f = 0; f < mesh.n_faces(); ++f) {
    expected.push_back(rotated({mesh.corners.begin() + mesh.offsets[f], mesh.corners.begin() + mesh.offsets[f + 1]}));
    std::vector<int> face;
    const PolygonMesh view = canonical.view();
    for (int c = view.face_offsets[f]; c < view.face_offsets[f + 1]; ++c) {
      face.push_back(canonical.vertices[view.corner_vertices[c]]);
    }
    found.push_back(rotated(face));
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  CHECK(expected == found);
}

TEST_CASE("only selected faces count, and coordinates may be no numbers") {
  Mesh mesh = quad_grid(3, 1);
  mesh.points[0].y() = std::numeric_limits<double>::quiet_NaN();
  mesh.seams = {{3, 7}, {1, 5}};
  PolygonMesh view = mesh.view();
  const bool selected[] = {true, true, false};
  view.selected_faces = selected;
  const CanonicalMesh canonical = CanonicalMesh::of(view);
  CHECK(canonical.view().n_faces == 2);
  CHECK(canonical.view().n_vertices == 6);
  CHECK(canonical.view().n_seam_edges == 1);
  CHECK(std::find(canonical.vertices.begin(), canonical.vertices.end(), 0) != canonical.vertices.end());
}

TEST_CASE("arrays that are no mesh are refused") {
  Mesh mesh = quad_grid(2, 2);
  mesh.corners[3] = 100;
  CHECK_THROWS_AS(CanonicalMesh::of(mesh.view()), InvalidMesh);
}

TEST_CASE("a polygon that comes to one vertex many times begins before the first of its next vertices") {
  for (const int n : {2, 3, 500}) {
    Mesh mesh({{0, 0, 0}}, {});
    std::vector<int> corners;
    for (int k = 0; k < n; ++k) {
      // The petal in the middle is the first by its vertices.
      mesh.points.emplace_back(1, (k + n - n / 2) % n, 0);
      mesh.points.emplace_back(2, k, 0);
      corners.insert(corners.end(), {0, 2 * k + 1, 2 * k + 2});
    }
    mesh.add(corners);
    const CanonicalMesh canonical = CanonicalMesh::of(mesh.view());
    const PolygonMesh view = canonical.view();
    REQUIRE(view.n_corners() == 3 * n);
    CHECK(view.corner_vertices[0] == 0);
    CHECK(view.corner_vertices[1] == 1);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
