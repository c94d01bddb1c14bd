#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "meshes.h"
#include "seams/carried_seams.h"

namespace spectral_conformal::test {
namespace {

/// A piece and its coarse copy.
struct TwoLevels : MirroredPieces {
  Mesh mesh;
  CoarsePiece coarse;

  TwoLevels(Mesh given, int fraction) : MirroredPieces(of(given.view())), mesh(std::move(given)) {
    REQUIRE(pieces.size() == 1);
    std::vector<signed char> side;
    for (const int v : pieces[0].vertices) side.push_back(symmetry.side[v]);
    const int n = static_cast<int>(pieces[0].vertices.size()) / fraction;
    coarse = coarse_piece(pieces[0], 0, mirrors[0], side, {}, n, {});
  }
  PieceSeams fine_seams() const { return {pieces[0], 0, mirrors[0], symmetry}; }
  PieceSeams coarse_seams() const { return {coarse.piece, 0, coarse.mirror, symmetry}; }
};

std::vector<Chart> charts_of(const PieceSeams& seams) {
  PolygonMesh view = seams.piece().view();
  const auto edges = seams.changed({}, {});
  view.seam_edges = edges.data();
  view.n_seam_edges = static_cast<int>(edges.size());
  return build_charts(view).charts;
}

/// (Euler characteristic, boundary loops) of each chart.
std::multiset<std::array<int, 2>> topology(const PieceSeams& seams) {
  std::multiset<std::array<int, 2>> result;
  for (const Chart& chart : charts_of(seams)) {
    result.insert({chart.euler_characteristic, static_cast<int>(chart.boundary_loops.size())});
  }
  return result;
}

/// The border of the faces whose center is above a height along an axis.
SeamEdges border_above(const PieceSeams& seams, int axis, double height) {
  const Piece& piece = seams.piece();
  const auto is_above = [&](int face) {
    double sum = 0;
    for (int c = piece.face_offsets[face]; c < piece.face_offsets[face + 1]; ++c) {
      sum += piece.positions(piece.corner_vertices[c], axis) - height;
    }
    return sum > 0;
  };
  SeamEdges cut;
  for (std::size_t e = 0; e < seams.graph().edges().size(); ++e) {
    const auto& edge = seams.graph().edges()[e];
    if (!edge.cut && is_above(edge.faces[0]) != is_above(edge.faces[1])) cut.push_back(static_cast<int>(e));
  }
  return seams.with_images(cut);
}

}  // namespace

TEST_SUITE_BEGIN("carried_seams");

TEST_CASE("the charts of the fine piece are those of the coarse one") {
  double ratios = 0;
  for (const int fraction : {3, 6}) {
    for (const Mesh& mesh : {torus(60, 30), sphere(14), perforated_grid(24, 24), spiky_grid(4, 6), double_torus()}) {
      for (const int axis : {0, 1, 2}) {
        const TwoLevels levels(mesh, fraction);
        PieceSeams from = levels.coarse_seams();
        from.open();
        const Positions& at = levels.coarse.piece.positions;
        for (const double position : {0.3, 0.7}) {
          const double low = at.col(axis).minCoeff();
          from.add(border_above(from, axis, low + position * (at.col(axis).maxCoeff() - low)));
        }
        PieceSeams to = levels.fine_seams();
        carry_seams(levels.coarse, from, to);
        CHECK(topology(to) == topology(from));
        CHECK(std::set<int>(to.edges().begin(), to.edges().end()).size() == to.edges().size());
        // Around a spike of few coarse edges one path may be long.
        CHECK(to.length(to.edges()) < 2 * from.length(from.edges()));
        ratios += to.length(to.edges()) / from.length(from.edges());
      }
    }
  }
  CHECK(ratios < 30);
}

TEST_CASE("carried seams of a symmetric piece are symmetric") {
  for (const Mesh& mesh : {sphere(14), spiky_grid(4, 6)}) {
    const TwoLevels levels(mesh, 4);
    PieceSeams from = levels.coarse_seams();
    from.open();
    from.add(border_above(from, 1, levels.coarse.piece.positions.col(1).mean() + 0.2));
    PieceSeams to = levels.fine_seams();
    carry_seams(levels.coarse, from, to);
    REQUIRE(to.is_symmetric() == from.is_symmetric());
    REQUIRE(to.is_symmetric());
    const std::set<int> edges(to.edges().begin(), to.edges().end());
    for (const int e : edges) {
      const auto& ends = to.graph().edges()[e].vertices;
      CHECK(edges.count(to.graph().find_edge(to.mirrored(ends[0]), to.mirrored(ends[1]))) == 1);
    }
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
