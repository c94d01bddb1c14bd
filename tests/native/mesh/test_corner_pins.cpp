#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "mesh/corner_pins.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

/// UVs equal to the first two coordinates, and no pins yet.
struct PinnedMesh {
  Mesh mesh;
  std::unique_ptr<bool[]> pinned;
  std::vector<double> uv;

  explicit PinnedMesh(Mesh m) : mesh(std::move(m)), pinned(new bool[mesh.corners.size()]()) {
    for (const int vertex : mesh.corners) {
      const Eigen::Vector3d& p = mesh.points[static_cast<std::size_t>(vertex)];
      uv.insert(uv.end(), {p.x(), p.y()});
    }
  }
  /// The corner of a face at a vertex.
  int corner(int face, int vertex) const {
    for (int c = mesh.offsets[face]; c < mesh.offsets[face + 1]; ++c) {
      if (mesh.corners[c] == vertex) return c;
    }
    FAIL("no such corner");
    return -1;
  }
  void pin(int c, double u, double v) {
    pinned[static_cast<std::size_t>(c)] = true;
    uv[2 * static_cast<std::size_t>(c)] = u;
    uv[2 * static_cast<std::size_t>(c) + 1] = v;
  }
  CornerPins pins() const { return {pinned.get(), uv.data()}; }
};

}  // namespace

TEST_SUITE_BEGIN("corner_pins");

TEST_CASE("equal pins split nothing and come back exactly") {
  PinnedMesh pinned(quad_grid(2, 1));  // vertices 0 1 2 / 3 4 5
  pinned.pin(pinned.corner(0, 1), 0.1, 0.7);
  pinned.pin(pinned.corner(1, 1), 0.1, 0.7);
  const PinSplitMesh split = PinSplitMesh::of(pinned.mesh.view(), pinned.pins());
  CHECK(split.view().n_vertices == 6);
  const ChartDecomposition charts = build_charts(split.view());
  REQUIRE(charts.charts.size() == 1);
  const Pins pins = chart_pins(split.view(), charts.charts[0], charts.chart_vertex_of_corner, pinned.pins());
  REQUIRE(pins.size() == 1);
  CHECK(pins.at(1) == Complex(0.1, 0.7));
}

TEST_CASE("two different pins split their vertex, and other corners go to the nearest") {
  PinnedMesh pinned(quad_grid(2, 2));  // the center is vertex 4
  pinned.pin(pinned.corner(0, 4), 0, 0);
  pinned.pin(pinned.corner(3, 4), 2, 2);
  const int near_second = pinned.corner(1, 4);
  pinned.uv[2 * static_cast<std::size_t>(near_second)] = 1.8;
  pinned.uv[2 * static_cast<std::size_t>(near_second) + 1] = 1.8;
  pinned.uv[2 * static_cast<std::size_t>(pinned.corner(2, 4))] = 0.1;
  const PinSplitMesh split = PinSplitMesh::of(pinned.mesh.view(), pinned.pins());
  const PolygonMesh view = split.view();
  REQUIRE(view.n_vertices == 10);
  CHECK(split.original_vertex(9) == 4);
  CHECK(view.corner_vertices[pinned.corner(0, 4)] == 4);
  CHECK(view.corner_vertices[pinned.corner(3, 4)] == 9);
  CHECK(view.corner_vertices[near_second] == 9);
  CHECK(view.corner_vertices[pinned.corner(2, 4)] == 4);
  CHECK(view.positions[27] == view.positions[12]);
}

TEST_CASE("pins of faces outside the selection do not count") {
  PinnedMesh pinned(quad_grid(2, 1));
  pinned.pin(pinned.corner(0, 1), 0, 0);
  pinned.pin(pinned.corner(1, 1), 2, 2);
  PolygonMesh mesh = pinned.mesh.view();
  const std::array<bool, 2> selected{true, false};
  mesh.selected_faces = selected.data();
  CHECK(PinSplitMesh::of(mesh, pinned.pins()).view().n_vertices == mesh.n_vertices);
}

TEST_CASE("seams run along all copies of a split vertex") {
  PinnedMesh pinned(quad_grid(2, 2));
  pinned.mesh.seams = {{7, 4}};  // between the faces 2 and 3
  pinned.pin(pinned.corner(0, 4), 0, 0);
  pinned.pin(pinned.corner(1, 4), 0, 0);
  pinned.pin(pinned.corner(2, 4), 2, 2);
  pinned.pin(pinned.corner(3, 4), 2, 2);
  const PinSplitMesh split = PinSplitMesh::of(pinned.mesh.view(), pinned.pins());
  CHECK(split.view().n_seam_edges == 2);
  const ChartDecomposition charts = build_charts(split.view());
  CHECK(charts.chart_of_face == std::vector<int>{0, 0, 1, 2});
}

TEST_CASE("seams around a pole with many pins are no more than its faces have sides") {
  // All pairs of copies would be 2 x 60 for each of 60 seams.
  constexpr int n = 60;
  Mesh fan;
  for (int v = 0; v < n; ++v) fan.points.emplace_back(std::cos(2 * pi * v / n), std::sin(2 * pi * v / n), 0);
  fan.points.emplace_back(0, 0, 1);
  for (int v = 0; v < n; ++v) {
    fan.add({v, (v + 1) % n, n});
    fan.seams.push_back({v, n});
  }
  PinnedMesh pinned(fan);
  for (int c = 0; c < 3 * n; ++c) pinned.pin(c, c, 0.5 * c);
  const PinSplitMesh split = PinSplitMesh::of(pinned.mesh.view(), pinned.pins());
  // Each seam and its copy in either face; the first pins, in the first face, keep their vertices.
  CHECK(split.view().n_seam_edges == 3 * n - 2);
  CHECK(build_charts(split.view()).charts.size() == n);
}

TEST_CASE("a pin that is not finite is named") {
  PinnedMesh pinned(quad_grid(2, 1));
  pinned.pin(pinned.corner(1, 2), std::numeric_limits<double>::infinity(), 0);
  const PinSplitMesh split = PinSplitMesh::of(pinned.mesh.view(), pinned.pins());
  const ChartDecomposition charts = build_charts(split.view());
  CHECK_THROWS_AS(chart_pins(split.view(), charts.charts[0], charts.chart_vertex_of_corner, pinned.pins()),
                  InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
