#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "mesh/mirror_symmetry.h"
#include "meshes.h"

#ifdef __linux__
#include <sys/resource.h>
#endif

namespace spectral_conformal::test {
namespace {

int matched_faces(const MirrorSymmetry& symmetry) {
  return static_cast<int>(std::count_if(symmetry.face.begin(), symmetry.face.end(), [](int f) { return f >= 0; }));
}

/// The most memory that the process has had; 0 where the system does not say.
long peak_kilobytes() {
#ifdef __linux__
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
#else
  return 0;
#endif
}

}  // namespace

TEST_SUITE_BEGIN("mirror_symmetry");

TEST_CASE("a symmetric mesh is mapped onto itself, wherever it lies") {
  Mesh mesh = spiky_grid(2, 3);
  for (Eigen::Vector3d& p : mesh.points) p += Eigen::Vector3d(1000, -50, 3);
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
  CHECK(symmetry.axis == 0);
  CHECK(matched_faces(symmetry) == mesh.n_faces());
  for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v) {
    const int image = symmetry.vertex[v];
    REQUIRE(image >= 0);
    CHECK(symmetry.vertex[image] == v);
    CHECK(mesh.points[v].x() + mesh.points[image].x() == doctest::Approx(2016));
    CHECK(symmetry.side[v] == (mesh.points[v].x() < 1008 ? -1 : mesh.points[v].x() > 1008 ? 1 : 0));
  }
  for (int f = 0; f < mesh.n_faces(); ++f) CHECK(symmetry.face[symmetry.face[f]] == f);
}

TEST_CASE("the plane with most faces is taken, and what has no image there is left out") {
  Mesh mesh = quad_grid(6, 3);
  mesh.points[0].z() = 5;  // a corner: the plane z = constant matches nothing, x and y lose one face each
  mesh.points[6].z() = 5;  // the other corner in x
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
  CHECK(symmetry.axis == 0);
  CHECK(matched_faces(symmetry) == mesh.n_faces());
}

TEST_CASE("a mesh without symmetry has few images, coordinates that are not finite none") {
  CHECK(matched_faces(find_mirror_symmetry(bumpy_grid(6, 5).view())) == 0);
  Mesh mesh = quad_grid(4, 4);
  mesh.points[12].x() = std::numeric_limits<double>::quiet_NaN();
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
  CHECK(symmetry.vertex[12] == -1);
  CHECK(matched_faces(symmetry) == 12);
  CHECK(find_mirror_symmetry(Mesh().view()).axis == -1);
}

TEST_CASE("vertices in the same place are told apart by their faces") {
  // Two sheets on each side that touch in one point each, where both have a vertex.
  Mesh mesh;
  for (const double side : {1.0, -1.0}) {
    for (const double up : {1.0, -1.0}) {
      mesh.append({{{side, 0, 0}, {2 * side, 0, up}, {2 * side, 1, 2 * up}}, {{0, 1, 2}}});
    }
  }
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
  CHECK(symmetry.axis == 0);
  CHECK(symmetry.face == std::vector<int>{2, 3, 0, 1});
}

TEST_CASE("unselected faces are no images") {
  const Mesh mesh = quad_grid(4, 1);
  PolygonMesh view = mesh.view();
  const bool selected[4] = {true, true, true, true};
  view.selected_faces = selected;
  CHECK(matched_faces(find_mirror_symmetry(view)) == 4);
  const bool left[4] = {true, true, false, false};
  view.selected_faces = left;
  // The center is that of the selection.
  CHECK(find_mirror_symmetry(view).face == std::vector<int>{1, 0, -1, -1});
}

TEST_CASE("a polygon of 50,000 corners takes no more memory than as many corners of quads") {
  // A prism without its bottom. A list of the other corners at each corner would hold 2.5e9 numbers, 10 GB.
  constexpr int n = 50000;
  Mesh mesh;
  std::vector<int> top(n);
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979323846 * (i + 0.5) / n;
    mesh.points.emplace_back(std::cos(angle), std::sin(angle), 1);
    top[static_cast<std::size_t>(i)] = i;
  }
  mesh.add(top);
  for (int i = 0; i < n; ++i) mesh.points.emplace_back(mesh.points[i] - 2 * Eigen::Vector3d::UnitZ());
  for (int i = 0; i < n; ++i) mesh.add({i, n + i, n + (i + 1) % n, (i + 1) % n});
  const long before = peak_kilobytes();
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view(), 1e-7);
  CHECK(peak_kilobytes() - before < 1'000'000);
  CHECK(symmetry.axis == 0);
  CHECK(matched_faces(symmetry) == n + 1);
  CHECK(symmetry.face[0] == 0);
}

TEST_CASE("a spot that the tolerance does not resolve takes no memory, and has no images") {
  // Lists of candidates would hold 40,000 x 40,000 numbers.
  Mesh mesh = cell_surface(1, [](int, int, int) { return true; });
  for (Eigen::Vector3d& p : mesh.points) p -= Eigen::Vector3d::Constant(0.5);
  const int n_cube = static_cast<int>(mesh.points.size());
  Mesh spot = quad_grid(200, 200);
  for (Eigen::Vector3d& p : spot.points) p *= 1e-8;
  mesh.append(spot);
  const long before = peak_kilobytes();
  const MirrorSymmetry symmetry = find_mirror_symmetry(mesh.view());
  CHECK(peak_kilobytes() - before < 200'000);
  CHECK(symmetry.axis == 0);
  CHECK(matched_faces(symmetry) == 6);
  CHECK(symmetry.vertex[n_cube] == -1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
