#include <doctest/doctest.h>

#include <cmath>
#include <utility>

#include "meshes.h"
#include "seams/pieces.h"

namespace spectral_conformal::test {
namespace {

struct Pieces : MirroredPieces {
  ChartDecomposition decomposition;

  explicit Pieces(const Mesh& mesh) : MirroredPieces(of(mesh.view())), decomposition(build_charts(mesh.view())) {}
};

}  // namespace

TEST_SUITE_BEGIN("pieces");

TEST_CASE("a piece is its chart as a mesh of its own, cut as the chart was") {
  Mesh mesh = quad_grid(6, 3);
  mesh.seams = {{3, 10}, {10, 17}, {17, 24}, {8, 9}, {9, 10}};  // across, and a slit into the left half
  const Pieces cut(mesh);
  REQUIRE(cut.pieces.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const ChartDecomposition again = build_charts(cut.pieces[i].view());
    REQUIRE(again.charts.size() == 1);
    const Chart& expected = cut.decomposition.charts[i];
    CHECK(again.charts[0].n_vertices() == expected.n_vertices());
    CHECK(again.charts[0].euler_characteristic == expected.euler_characteristic);
    CHECK(cut.pieces[i].faces == expected.faces);
    CHECK(cut.pieces[i].vertices == expected.vertices);
  }
}

TEST_CASE("the area of a piece is that of its faces, bent ones as their vector areas") {
  Mesh mesh = quad_grid(6, 3);
  mesh.seams = {{3, 10}, {10, 17}, {17, 24}};
  for (const Piece& piece : Pieces(mesh).pieces) CHECK(piece.area() == doctest::Approx(9));
  Mesh bent = quad_grid(1, 1);
  bent.points[0].z() = 2;
  CHECK(Pieces(bent).pieces[0].area() == doctest::Approx(std::sqrt(1 + 1 + 1)));
}

TEST_CASE("a seam whose ends stay whole remains a seam of the piece") {
  Mesh mesh = quad_grid(4, 4);
  mesh.seams = {{13, 12}};
  const Pieces slit(mesh);
  REQUIRE(slit.pieces.size() == 1);
  CHECK(slit.pieces[0].seams == std::vector<std::array<int, 2>>{{12, 13}});
  CHECK(slit.mirrors[0].image == -1);  // the seam is on one side only
}

TEST_CASE("an edge of four faces is a seam of the piece that has two of them joined around both ends") {
  // Two fins on either of two opposite edges of a tetrahedron.
  Mesh finned = tetrahedron();
  REQUIRE(finned.points.size() == 4);
  for (const auto& [a, b] : {std::pair{0, 1}, {2, 3}}) {
    for (const double side : {3.0, -3.0}) {
      finned.points.emplace_back(0.5 * side, 0.3 * a, side);
      finned.add({a, b, static_cast<int>(finned.points.size()) - 1});
    }
  }
  const Pieces pieces(finned);
  REQUIRE(pieces.pieces.size() == 5);
  CHECK(pieces.pieces[0].seams == std::vector<std::array<int, 2>>{{0, 1}, {2, 3}});
  const ChartDecomposition again = build_charts(pieces.pieces[0].view());
  REQUIRE(again.charts.size() == 1);
  CHECK(again.charts[0].boundary_loops.size() == 2);
}

TEST_CASE("pieces are mapped onto themselves or each other") {
  const Pieces whole(quad_grid(6, 3));
  CHECK(whole.mirrors[0].image == 0);
  CHECK(whole.mirrors[0].vertex[0] == 6);
  CHECK(whole.mirrors[0].face[0] == 5);
  Mesh halved = quad_grid(6, 3);
  halved.seams = {{3, 10}, {10, 17}, {17, 24}};
  const Pieces halves(halved);
  CHECK(halves.mirrors[0].image == 1);
  CHECK(halves.mirrors[1].image == 0);
  for (std::size_t v = 0; v < halves.mirrors[0].vertex.size(); ++v) {
    CHECK(halves.mirrors[1].vertex[halves.mirrors[0].vertex[v]] == static_cast<int>(v));
  }
  Mesh uneven = quad_grid(6, 3);
  uneven.seams = {{2, 9}, {9, 16}, {16, 23}};
  for (const PieceMirror& mirror : Pieces(uneven).mirrors) CHECK(mirror.image == -1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
