#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "meshes.h"
#include "seams/seam_settling.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal::test {
namespace {

constexpr std::int64_t all_vertices = std::numeric_limits<std::int64_t>::max();

struct Cut {
  MirroredPieces parts;
  SeamSuggestionOptions options;
  CutPiece piece;

  explicit Cut(const Mesh& mesh, bool all_edges)
      : parts(MirroredPieces::of(mesh.view())), piece(seams_of(parts, all_edges), options, 0) {
    piece.solve({}, {});
  }
  static PieceSeams seams_of(const MirroredPieces& parts, bool all_edges) {
    PieceSeams seams(parts.pieces[0], 0, parts.mirrors[0], parts.symmetry);
    seams.forget_symmetry();
    SeamEdges cut;
    for (std::size_t e = 0; all_edges && e < seams.graph().edges().size(); ++e) {
      if (!seams.graph().edges()[e].cut) cut.push_back(static_cast<int>(e));
    }
    seams.add(cut);
    if (!all_edges) seams.open();
    return seams;
  }
};

/// The least value that any choice of the edges has without defects.
double least_value(const Cut& cut) {
  const int n_edges = static_cast<int>(cut.piece.seams().graph().edges().size());
  double least = std::numeric_limits<double>::infinity();
  for (int choice = 0; choice < 1 << n_edges; ++choice) {
    SeamEdges added;
    for (int e = 0; e < n_edges; ++e) {
      if ((choice >> e & 1) != 0) added.push_back(e);
    }
    const SeamTrial trial = cut.piece.attempt(added, cut.piece.seams().edges(), {}, {});
    if (trial.value < least && cut.piece.is_sound(trial)) least = trial.value;
  }
  return least;
}

}  // namespace

TEST_SUITE_BEGIN("seam_settling");

TEST_CASE("a tiny solid with all edges cut gets better, and the search finds the best of all choices") {
  const Mesh tetrahedron({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  for (const Mesh& mesh : {tetrahedron, cell_surface(1, [](int, int, int) { return true; })}) {
    Cut cut(mesh, true);
    const double before = cut.piece.value();
    settle_seams(cut.piece, all_vertices, {});
    CHECK(cut.piece.value() < before);
    const double least = least_value(cut);
    const Piece& piece = cut.parts.pieces[0];
    SeamEdges found;
    for (auto [a, b] : suggest_seams(mesh.view(), cut.options, {}).edges) {
      const auto in_piece = [&](int v) {
        return static_cast<int>(std::find(piece.vertices.begin(), piece.vertices.end(), v) - piece.vertices.begin());
      };
      found.push_back(cut.piece.seams().graph().find_edge(in_piece(a), in_piece(b)));
    }
    const SeamTrial suggested = cut.piece.attempt(found, cut.piece.seams().edges(), {}, {});
    CHECK(suggested.value == doctest::Approx(least));
  }
}

TEST_CASE("islands shorter around than their price join their neighbors before anything else") {
  const MirroredPieces parts = MirroredPieces::of(quad_grid(30, 30).view());
  SeamSuggestionOptions options;
  options.style = SeamStyle::organic;  // an island costs as much as 4.5 edges
  PieceSeams seams(parts.pieces[0], 0, parts.mirrors[0], parts.symmetry);
  seams.forget_symmetry();
  const std::vector<SeamGraph::Edge>& edges = seams.graph().edges();
  const auto has_face = [](const SeamGraph::Edge& edge, int face) {
    return edge.faces[0] == face || edge.faces[1] == face;
  };
  const auto in_left_half = [](int face) { return face % 30 < 15; };
  SeamEdges halves;
  SeamEdges crumbs;
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    if (edges[e].cut) continue;
    if (in_left_half(edges[e].faces[0]) != in_left_half(edges[e].faces[1])) halves.push_back(e);
    if (has_face(edges[e], 45) || has_face(edges[e], 400) || has_face(edges[e], 401)) crumbs.push_back(e);
  }
  seams.add(halves);
  for (const int e : crumbs) {
    if (!edges[e].cut) seams.add({e});
  }
  CutPiece piece(std::move(seams), options, 0);
  piece.solve({}, {});
  REQUIRE(piece.charts().size() == 5);
  settle_seams(piece, 1, {});
  CHECK(piece.charts().size() == 2);
  // A slit between the two neighbors is left for later trials.
  CHECK(piece.seams().edges().size() == halves.size() + 1);
}

TEST_CASE("no move raises the functional, and none is made where no vertex may be solved for") {
  for (const Mesh& mesh : {sphere(5), torus(12, 8)}) {
    Cut cut(mesh, false);
    const double before = cut.piece.value();
    const SeamEdges edges = cut.piece.seams().edges();
    settle_seams(cut.piece, 0, {});
    CHECK(cut.piece.seams().edges() == edges);
    settle_seams(cut.piece, all_vertices, {});
    CHECK(cut.piece.value() <= before);
    const SeamTrial same = cut.piece.attempt({}, {}, {}, {});
    CHECK(same.value == cut.piece.value());
  }
}

TEST_CASE("shortened seams cost less, for distortion within the limits") {
  const Mesh mesh = sphere(8);
  Cut cut(mesh, true);
  cut.options.energy_limit = 4.8;
  cut.options.qc_limit = cut.options.scale_limit = 1e6;
  settle_seams(cut.piece, all_vertices, {});
  const MapQuality before = cut.piece.quality();
  const double seams_value = cut.piece.seams_value();
  REQUIRE(before.energy < 4.7);
  shorten_seams(cut.piece, all_vertices, {});
  CHECK(cut.piece.seams_value() < seams_value);
  CHECK(cut.piece.quality().energy > before.energy);
  CHECK(cut.piece.quality().energy <= 4.8);
}

TEST_CASE("seams that zigzag over a sheet are straightened all at once") {
  Mesh grid = quad_grid(12, 12);
  for (Eigen::Vector3d& p : grid.points) p.z() = 0.02 * p.x() * p.x() + 0.001 * p.y() * p.x();  // without symmetry
  Cut cut(grid, false);
  PieceSeams seams = cut.piece.seams();
  const auto vertex = [](int x, int y) { return 13 * y + x; };
  SeamEdges zigzag;
  for (const int y : {3, 8}) {
    for (int x = 0; x < 12; ++x) {
      const int row = y + x % 2;
      zigzag.push_back(seams.graph().find_edge(vertex(x, row), vertex(x + 1, row)));
      if (x < 11) zigzag.push_back(seams.graph().find_edge(vertex(x + 1, row), vertex(x + 1, y + (x + 1) % 2)));
    }
  }
  REQUIRE(std::find(zigzag.begin(), zigzag.end(), -1) == zigzag.end());
  seams.add(zigzag);
  CutPiece piece(seams, cut.options, 0);
  piece.solve({}, {});
  const int n_vertices = seams.graph().n_vertices();
  settle_seams(piece, n_vertices, {});  // one solve of all charts
  CHECK(piece.seams().edges().size() <= 2 * 13);
  CHECK(piece.charts().size() == 3);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
