#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "mesh/charts.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

ChartDecomposition charts_of(const Mesh& mesh) { return build_charts(mesh.view()); }

/// What must hold for every decomposition: faces and corners are accounted for, triangles are wound alike, and loops
/// and the Euler characteristic are those of the triangles.
void check_consistent(const Mesh& mesh, const ChartDecomposition& decomposition) {
  for (std::size_t i = 0; i < decomposition.charts.size(); ++i) {
    const Chart& chart = decomposition.charts[i];
    CHECK(std::is_sorted(chart.faces.begin(), chart.faces.end()));
    CHECK(std::is_sorted(chart.vertices.begin(), chart.vertices.end()));
    REQUIRE(chart.triangle_weights.size() == chart.triangles.size());
    REQUIRE(chart.triangle_face.size() == chart.triangles.size());
    for (const int face : chart.faces) {
      CHECK(decomposition.chart_of_face[face] == static_cast<int>(i));
      for (int c = mesh.offsets[face]; c < mesh.offsets[face + 1]; ++c) {
        CHECK(chart.vertices[decomposition.chart_vertex_of_corner[c]] == mesh.corners[c]);
      }
    }
    // Directed edges with the weights of their triangles; those of quads' inner splits cancel.
    std::map<std::array<int, 2>, double> directed;
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
      const auto& triangle = chart.triangles[t];
      for (int k = 0; k < 3; ++k) directed[{triangle[k], triangle[(k + 1) % 3]}] += chart.triangle_weights[t];
    }
    if (!chart.orientable) continue;
    std::set<std::array<int, 2>> boundary;
    for (const auto& [edge, covered] : directed) {
      const auto opposite = directed.find({edge[1], edge[0]});
      const double balance = covered - (opposite == directed.end() ? 0 : opposite->second);
      if (balance > 0.25) boundary.insert(edge);
    }
    std::set<std::array<int, 2>> in_loops;
    for (const BoundaryLoop& loop : chart.boundary_loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) in_loops.insert({loop[k], loop[(k + 1) % loop.size()]});
    }
    CHECK(in_loops == boundary);
  }
}

Chart checked_chart(const Mesh& mesh) {
  const ChartDecomposition decomposition = charts_of(mesh);
  check_consistent(mesh, decomposition);
  REQUIRE(decomposition.charts.size() == 1);
  return decomposition.charts.front();
}

}  // namespace

TEST_SUITE_BEGIN("charts");

TEST_CASE("Euler characteristic, loops and genus of known surfaces") {
  struct Known {
    Mesh mesh;
    int euler, loops, genus;
  };
  Mesh punctured_torus = torus(8, 6);
  punctured_torus.offsets.pop_back();
  punctured_torus.corners.resize(punctured_torus.corners.size() - 4);
  const Known known[] = {{flat_grid(4, 3), 1, 1, 0}, {quad_grid(4, 3), 1, 1, 0}, {perforated_grid(7, 4), -1, 3, 0},
                         {ring(9, 0), 0, 2, 0},      {ring(9, 2), 0, 2, 0},      {tetrahedron(), 2, 0, 0},
                         {torus(8, 6), 0, 0, 1},     {punctured_torus, -1, 1, 1}};
  for (const Known& k : known) {
    const Chart chart = checked_chart(k.mesh);
    CHECK(chart.orientable);
    CHECK(chart.euler_characteristic == k.euler);
    CHECK(static_cast<int>(chart.boundary_loops.size()) == k.loops);
    CHECK(chart.genus() == k.genus);
    CHECK(chart.reversed_faces == 0);
  }
}

TEST_CASE("a Moebius strip is not orientable, however its faces are wound") {
  for (const int half_twists : {1, 3}) {
    Mesh mesh = ring(9, half_twists);
    CHECK_FALSE(checked_chart(mesh).orientable);
    mesh.reverse(4);
    CHECK_FALSE(checked_chart(mesh).orientable);
  }
  Mesh cut = ring(9, 1);
  cut.seams = {{6, 7}};
  const Chart strip = checked_chart(cut);
  CHECK(strip.orientable);
  CHECK(strip.euler_characteristic == 1);
}

TEST_CASE("a seam across a patch makes two charts, in the order of their first faces") {
  Mesh mesh = quad_grid(4, 2);
  mesh.seams = {{2, 7}, {12, 7}};
  const ChartDecomposition decomposition = charts_of(mesh);
  check_consistent(mesh, decomposition);
  REQUIRE(decomposition.charts.size() == 2);
  CHECK(decomposition.chart_of_face == std::vector<int>{0, 0, 1, 1, 0, 0, 1, 1});
  for (const Chart& chart : decomposition.charts) CHECK(chart.n_vertices() == 9);
  CHECK(decomposition.split_vertices == 0);
}

TEST_CASE("a seam that ends inside opens a slit: its end stays one vertex, the others get two copies") {
  Mesh mesh = quad_grid(4, 4);
  mesh.seams = {{2, 7}, {7, 12}};
  const ChartDecomposition decomposition = charts_of(mesh);
  check_consistent(mesh, decomposition);
  REQUIRE(decomposition.charts.size() == 1);
  const auto& vertices = decomposition.charts[0].vertices;
  CHECK(std::count(vertices.begin(), vertices.end(), 2) == 2);
  CHECK(std::count(vertices.begin(), vertices.end(), 7) == 2);
  CHECK(std::count(vertices.begin(), vertices.end(), 12) == 1);
  CHECK(decomposition.split_vertices == 2);
  CHECK(decomposition.charts[0].euler_characteristic == 1);
  mesh.seams = {{7, 12}};  // an edge alone inside cuts nothing
  CHECK(charts_of(mesh).split_vertices == 0);
}

TEST_CASE("seams along the boundary, doubled, or between unrelated vertices change nothing") {
  Mesh mesh = quad_grid(3, 3);
  const Chart plain = checked_chart(mesh);
  mesh.seams = {{0, 1}, {0, 15}, {5, 5}};
  const Chart chart = checked_chart(mesh);
  CHECK(chart.vertices == plain.vertices);
  CHECK(chart.triangles == plain.triangles);
}

TEST_CASE("only selected faces count: patches and their boundaries are those of the selection") {
  const Mesh mesh = quad_grid(3, 3);
  PolygonMesh view = mesh.view();
  const bool ring_of_eight[] = {true, true, true, true, false, true, true, true, true};
  view.selected_faces = ring_of_eight;
  ChartDecomposition decomposition = build_charts(view);
  REQUIRE(decomposition.charts.size() == 1);
  CHECK(decomposition.charts[0].boundary_loops.size() == 2);
  CHECK(decomposition.chart_of_face[4] == -1);
  for (int c = 16; c < 20; ++c) CHECK(decomposition.chart_vertex_of_corner[c] == -1);
  const bool corners_only[] = {true, false, true, false, false, false, true, false, true};
  view.selected_faces = corners_only;
  CHECK(build_charts(view).charts.size() == 4);
  const bool none[9] = {};
  view.selected_faces = none;
  CHECK(build_charts(view).charts.empty());
}

TEST_CASE("an edge of three faces splits, and only the selected ones count") {
  const Mesh fin({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const ChartDecomposition decomposition = charts_of(fin);
  check_consistent(fin, decomposition);
  CHECK(decomposition.charts.size() == 3);
  CHECK(decomposition.non_manifold_edges == 1);
  PolygonMesh view = fin.view();
  const bool two[] = {true, true, false};
  view.selected_faces = two;
  CHECK(build_charts(view).charts.size() == 1);
  CHECK(build_charts(view).non_manifold_edges == 0);
}

TEST_CASE("a bow tie: faces that share a vertex only are two charts; within one chart the vertex has two copies") {
  const Mesh two({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}});
  CHECK(charts_of(two).charts.size() == 2);
  CHECK(charts_of(two).split_vertices == 0);
  const Mesh pinched = pinched_ring();
  const ChartDecomposition decomposition = charts_of(pinched);
  check_consistent(pinched, decomposition);
  REQUIRE(decomposition.charts.size() == 1);
  const auto& vertices = decomposition.charts[0].vertices;
  CHECK(std::count(vertices.begin(), vertices.end(), 10) == 2);
  CHECK(decomposition.split_vertices == 1);
  CHECK(decomposition.charts[0].euler_characteristic == 1);
}

TEST_CASE("faces wound against the majority are turned") {
  Mesh mesh = flat_grid(4, 4);
  const Chart plain = checked_chart(mesh);
  for (const int face : {0, 7, 8, 20}) mesh.reverse(face);
  const Chart chart = checked_chart(mesh);
  CHECK(chart.reversed_faces == 4);
  CHECK(chart.orientable);
  CHECK(chart.vertices == plain.vertices);
  const auto sorted = [](const Chart& c) {
    std::set<std::array<int, 3>> set;
    for (auto t : c.triangles) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      set.insert(t);
    }
    return set;
  };
  CHECK(sorted(chart) == sorted(plain));
  for (int face = 0; face < mesh.n_faces(); ++face) mesh.reverse(face);  // now 28 of 32 are wound the other way
  CHECK(sorted(checked_chart(mesh)) != sorted(plain));
  CHECK(checked_chart(mesh).reversed_faces == 4);
}

TEST_CASE("of faces on the same vertices one is kept, the others take its corners' vertices") {
  for (const bool reversed : {false, true}) {
    Mesh mesh = flat_grid(3, 3);
    const Chart plain = checked_chart(mesh);
    for (const int twin : {4, 9, 4}) {
      mesh.add({mesh.corners[3 * twin + 1], mesh.corners[3 * twin + 2], mesh.corners[3 * twin]});
      if (reversed) mesh.reverse(mesh.n_faces() - 1);
    }
    const ChartDecomposition decomposition = charts_of(mesh);
    check_consistent(mesh, decomposition);
    REQUIRE(decomposition.charts.size() == 1);
    CHECK(decomposition.charts[0].triangles == plain.triangles);
    CHECK(decomposition.charts[0].duplicates == std::vector<int>{18, 19, 20});
    CHECK(decomposition.non_manifold_edges == 0);
    for (std::size_t c = 54; c < mesh.corners.size(); ++c) {
      CHECK(decomposition.charts[0].vertices[decomposition.chart_vertex_of_corner[c]] == mesh.corners[c]);
      CHECK(decomposition.chart_of_face[18] == 0);
    }
  }
}

TEST_CASE("two triangles back to back are one face, a tetrahedron is not") {
  const Mesh pillow({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}});
  CHECK(checked_chart(pillow).duplicates == std::vector<int>{1});
  CHECK(checked_chart(tetrahedron()).duplicates.empty());
}

TEST_CASE("degenerate faces are set apart") {
  Mesh mesh = quad_grid(2, 1);
  mesh.add({0, 1, 0});
  mesh.add({0, 0, 1, 4});
  mesh.add({0, 1, 0, 1});
  mesh.add({0, 1});
  mesh.add({});
  const ChartDecomposition decomposition = charts_of(mesh);
  check_consistent(mesh, decomposition);
  CHECK(decomposition.charts.size() == 1);
  CHECK(decomposition.degenerate_faces == std::vector<int>{2, 3, 4, 5, 6});
  for (int face = 2; face < 7; ++face) CHECK(decomposition.chart_of_face[face] == -1);
}

TEST_CASE("a polygon that meets itself in a vertex keeps its fans apart") {
  Mesh mesh({{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2, 0, 3, 4}});
  const ChartDecomposition decomposition = charts_of(mesh);
  REQUIRE(decomposition.charts.size() == 1);
  CHECK(decomposition.charts[0].n_vertices() == 6);
  CHECK(decomposition.split_vertices == 1);
}

TEST_CASE("reversed polygons are triangulated like their neighbors") {
  Mesh mesh({{0, 0, 0},
             {3, 0, 0},
             {3, 1, 0},
             {1, 1, 0},
             {1, 4, 0},
             {0, 4, 0},
             {-2, 0, 0},
             {-2, 4, 0},
             {3, -2, 0},
             {0, -2, 0}},
            {{0, 1, 2, 3, 4, 5}, {6, 0, 5, 7}, {9, 8, 1, 0}});
  mesh.reverse(0);
  const Chart chart = checked_chart(mesh);
  CHECK(chart.reversed_faces == 1);
  CHECK(chart.self_intersecting_polygons == 0);
  const Positions positions = chart.positions(mesh.view());
  for (const auto& [a, b, c] : chart.triangles) {
    const Eigen::RowVector3d e1 = positions.row(b) - positions.row(a), e2 = positions.row(c) - positions.row(a);
    CHECK(e1[0] * e2[1] - e1[1] * e2[0] > 0);
  }
}

TEST_CASE("an empty mesh has no charts, and vertices without faces are in none") {
  CHECK(charts_of({}).charts.empty());
  Mesh mesh = quad_grid(1, 1);
  mesh.points.emplace_back(9, 9, 9);
  CHECK(checked_chart(mesh).n_vertices() == 4);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
