#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "meshes.h"
#include "seams/filled_piece.h"
#include "seams/seam_graph.h"

namespace spectral_conformal::test {
namespace {

/// A curved square of n by n quads, its own mirror image, without every eleventh of them in both directions and with a
/// window of six by six in its middle.
Mesh sieve(int n) {
  const Mesh grid = quad_grid(n, n);
  Mesh mesh;
  mesh.points = grid.points;
  for (Eigen::Vector3d& point : mesh.points) point.z() = 0.1 * std::abs(point.x() - 0.5 * n) + 0.02 * point.y();
  for (int f = 0; f < grid.n_faces(); ++f) {
    const int x = std::min(f % n, n - 1 - f % n);
    const int y = f / n;
    const bool in_window = x >= n / 2 - 3 && y >= n / 2 - 3 && y < n / 2 + 3;
    if ((x % 11 == 5 && y % 11 == 5) || in_window) continue;
    mesh.add({grid.corners.begin() + grid.offsets[f], grid.corners.begin() + grid.offsets[f + 1]});
  }
  return mesh;
}

struct WholePiece {
  Piece piece;
  PieceMirror mirror;

  explicit WholePiece(const Mesh& mesh) {
    const MirroredPieces parts = MirroredPieces::of(mesh.view());
    REQUIRE(parts.pieces.size() == 1);
    piece = parts.pieces.front();
    mirror = parts.mirrors.front();
  }
};

std::set<int> corners_of(const Piece& piece, int face) {
  return {piece.corner_vertices.begin() + piece.face_offsets[face],
          piece.corner_vertices.begin() + piece.face_offsets[face + 1]};
}

}  // namespace

TEST_SUITE_BEGIN("filled_piece");

TEST_CASE("small holes are filled, on the same vertices and edges, and larger ones stay") {
  const WholePiece torn(sieve(110));
  const auto filled = fill_small_holes(torn.piece, 0, torn.mirror);
  REQUIRE(filled);
  const Chart before = build_charts(torn.piece.view()).charts.front();
  const ChartDecomposition after = build_charts(filled->piece.view());
  REQUIRE(after.charts.size() == 1);
  CHECK(before.boundary_loops.size() > 90);
  CHECK(after.charts.front().boundary_loops.size() == 2);
  CHECK(after.charts.front().reversed_faces == 0);
  CHECK(filled->piece.n_faces() == torn.piece.n_faces() + static_cast<int>(before.boundary_loops.size()) - 2);
  CHECK(filled->piece.positions == torn.piece.positions);
  CHECK(filled->piece.vertices == torn.piece.vertices);
  const SeamGraph graph = SeamGraph::of(torn.piece.view());
  const SeamGraph graph_filled = SeamGraph::of(filled->piece.view());
  REQUIRE(graph.edges().size() == graph_filled.edges().size());
  for (std::size_t e = 0; e < graph.edges().size(); ++e) {
    CHECK(graph.edges()[e].vertices == graph_filled.edges()[e].vertices);
  }
}

TEST_CASE("what fills a hole has an image where the piece is its own") {
  const WholePiece torn(sieve(110));
  REQUIRE(torn.mirror.image == 0);
  const auto filled = fill_small_holes(torn.piece, 0, torn.mirror);
  REQUIRE(filled);
  REQUIRE(static_cast<int>(filled->mirror.face.size()) == filled->piece.n_faces());
  for (int f = 0; f < filled->piece.n_faces(); ++f) {
    std::set<int> image;
    for (const int v : corners_of(filled->piece, f)) image.insert(filled->mirror.vertex[static_cast<std::size_t>(v)]);
    CHECK(image == corners_of(filled->piece, filled->mirror.face[static_cast<std::size_t>(f)]));
  }
}

TEST_CASE("a piece without small holes stays as it is") {
  for (const Mesh& mesh : {sphere(6), perforated_grid(12, 12), quad_grid(4, 4)}) {
    const WholePiece whole(mesh);
    CHECK_FALSE(fill_small_holes(whole.piece, 0, whole.mirror));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
