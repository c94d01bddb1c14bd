#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "meshes.h"
#include "seams/edge_marks.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("edge_marks");

namespace {

/// Two quads side by side, mirrored at their common edge, with the vertices numbered from 10 on by the caller.
struct TwoQuads {
  Mesh mesh = quad_grid(2, 1);
  MirroredPieces parts{mesh.view()};
  std::vector<int> given{10, 11, 12, 13, 14, 15};

  std::vector<double> raised(const std::vector<std::array<int, 2>>& edges, bool is_coarse) const {
    SeamSuggestionOptions options;
    options.avoided_edges = edges.data();
    options.n_avoided_edges = static_cast<int>(edges.size());
    const EdgeMarks marks(options, parts.symmetry, given);
    const SeamGraph graph(parts.pieces[0].view());
    std::vector<double> factors(graph.edges().size(), 1);
    marks.scale(graph, parts.pieces[0], is_coarse, factors);
    return factors;
  }
  std::vector<double> scaled(const std::vector<std::array<int, 2>>& edges, const std::vector<double>& strengths,
                             bool is_coarse) const {
    SeamSuggestionOptions options;
    options.preferred_edges = edges.data();
    options.edge_preference = strengths.data();
    options.n_preferred_edges = static_cast<int>(edges.size());
    SeamGraph graph(parts.pieces[0].view());
    std::vector<double> factors(graph.edges().size(), 1);
    EdgeMarks(options, parts.symmetry, given).scale(graph, parts.pieces[0], is_coarse, factors);
    return factors;
  }
  double factor(const std::vector<double>& factors, int a, int b) const {
    const SeamGraph graph(parts.pieces[0].view());
    const std::vector<int>& vertices = parts.pieces[0].vertices;
    for (std::size_t e = 0; e < factors.size(); ++e) {
      const auto [i, j] = graph.edges()[e].vertices;
      const int first = given[static_cast<std::size_t>(vertices[static_cast<std::size_t>(i)])];
      const int second = given[static_cast<std::size_t>(vertices[static_cast<std::size_t>(j)])];
      if ((first == a && second == b) || (first == b && second == a)) return factors[e];
    }
    FAIL("no such edge");
    return 0;
  }
  bool is_raised(const std::vector<double>& factors, int a, int b) const { return factor(factors, a, b) > 1; }
};

}  // namespace

TEST_CASE("edges in the caller's numbers, and their mirror images") {
  const TwoQuads quads;
  const std::vector<double> factors = quads.raised({{11, 10}, {0, 99}}, false);
  CHECK(quads.is_raised(factors, 10, 11));
  CHECK(quads.is_raised(factors, 11, 12));
  CHECK_FALSE(quads.is_raised(factors, 11, 14));
  CHECK_FALSE(quads.is_raised(factors, 13, 14));
}

TEST_CASE("on coarse copies all edges between ends of avoided ones") {
  const TwoQuads quads;
  const std::vector<std::array<int, 2>> edges{{10, 13}, {11, 12}};
  CHECK_FALSE(quads.is_raised(quads.raised(edges, false), 11, 14));
  CHECK_FALSE(quads.is_raised(quads.raised(edges, true), 11, 14));
  CHECK(quads.is_raised(quads.raised({{10, 11}, {13, 14}}, true), 11, 14));
}

TEST_CASE("preferred edges cost what their strongest mark says, on coarse copies that of the weaker end") {
  const TwoQuads quads;
  // The edge between the quads, in a plane, costs twice its length; a twentieth of that with a mark of full strength.
  const auto inner = [&](const std::vector<std::array<int, 2>>& edges, const std::vector<double>& strengths,
                         bool is_coarse) { return quads.factor(quads.scaled(edges, strengths, is_coarse), 11, 14); };
  CHECK(inner({{14, 11}}, {1}, false) == doctest::Approx(1 / 20.0));
  CHECK(inner({{11, 14}, {14, 11}, {11, 14}}, {0.25, 0.5, 0}, false) == doctest::Approx(1 / std::sqrt(20.0)));
  CHECK(inner({{10, 11}, {13, 14}}, {0.5, 1}, false) == 1);
  CHECK(inner({{10, 11}, {13, 14}}, {0.5, 1}, true) == doctest::Approx(1 / std::sqrt(20.0)));
  CHECK(inner({{11, 14}}, {0}, true) == 1);
}

TEST_CASE("without any nothing changes") {
  const TwoQuads quads;
  for (const double factor : quads.raised({}, true)) CHECK(factor == 1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
