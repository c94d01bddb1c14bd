#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "seams/piece_search.h"
#include "seams/seam_graph.h"

namespace spectral_conformal::test {
namespace {

/// The first piece of a mesh, and all that its search looks at.
struct Searched {
  Mesh mesh;
  SeamSuggestionOptions options;
  MirroredPieces parts;
  std::vector<int> vertices;
  SearchedMesh view{options, parts, vertices};

  explicit Searched(Mesh given) : mesh(std::move(given)), parts(MirroredPieces::of(mesh.view())) {
    for (int v = 0; v < mesh.view().n_vertices; ++v) vertices.push_back(v);
  }
};

}  // namespace

TEST_SUITE_BEGIN("piece_search");

TEST_CASE("a search ends with cuts along edges of the piece, first what topology needs") {
  const Searched searched(sphere(9));
  PieceSearch search(searched.view, 0);
  search.begin({});
  CHECK_FALSE(search.is_large());
  CHECK(search.length() > 0);
  while (!search.finished()) {
    CHECK_FALSE(std::isnan(search.urgency()));
    search.step(infinity, {});
  }
  const std::vector<PieceSearch::Cut> cuts = search.cuts();
  REQUIRE_FALSE(cuts.empty());
  CHECK(std::isinf(cuts.front().urgency));
  const SeamGraph graph = SeamGraph::of(searched.parts.pieces.front().view());
  double length = 0;
  for (const PieceSearch::Cut& cut : cuts) {
    CHECK_FALSE(cut.edges.empty());
    for (const auto& [a, b] : cut.edges) {
      CHECK(graph.find_edge(a, b) >= 0);
      length +=
          (searched.parts.pieces.front().positions.row(a) - searched.parts.pieces.front().positions.row(b)).norm();
    }
  }
  CHECK(search.length() == doctest::Approx(length).epsilon(1e-9));
}

TEST_CASE("no cut is longer than it may be, but for what topology needs") {
  Searched searched(spiky_grid(2, 8));
  for (const double longest : {0.0, infinity}) {
    searched.options.max_length = longest;
    PieceSearch search(searched.view, 0);
    search.begin({});
    while (!search.finished()) search.step(longest, {});
    CHECK(search.cuts().empty() == (longest == 0));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
