#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "meshes.h"
#include "seams/seam_preferences.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("seam_preferences");

namespace {

std::vector<int> numbers(const Mesh& mesh) {
  std::vector<int> result(mesh.points.size());
  std::iota(result.begin(), result.end(), 0);
  return result;
}

/// Of a mesh of one piece.
std::vector<double> factors_of(const Mesh& mesh, const SeamSuggestionOptions& options, const std::vector<int>& given) {
  const MirroredPieces parts = MirroredPieces::of(mesh.view());
  return SeamPreferences(options, parts.symmetry, given)
      .cost_factors(SeamGraph::of(mesh.view()), parts.pieces[0], false);
}

/// Two quads side by side, mirrored at their common edge, with the vertices numbered from 10 on by the caller.
struct TwoQuads {
  Mesh mesh = quad_grid(2, 1);
  MirroredPieces parts = MirroredPieces::of(mesh.view());
  std::vector<int> given{10, 11, 12, 13, 14, 15};

  std::vector<double> factors(const SeamSuggestionOptions& options, bool is_coarse) const {
    const SeamGraph graph = SeamGraph::of(parts.pieces[0].view());
    return SeamPreferences(options, parts.symmetry, given).cost_factors(graph, parts.pieces[0], is_coarse);
  }
  std::vector<double> raised(const std::vector<std::array<int, 2>>& edges, bool is_coarse) const {
    SeamSuggestionOptions options;
    options.avoided_edges = edges.data();
    options.n_avoided_edges = static_cast<int>(edges.size());
    return factors(options, is_coarse);
  }
  std::vector<double> scaled(const std::vector<std::array<int, 2>>& edges, const std::vector<double>& strengths,
                             bool is_coarse) const {
    SeamSuggestionOptions options;
    options.preferred_edges = edges.data();
    options.edge_preference = strengths.data();
    options.n_preferred_edges = static_cast<int>(edges.size());
    return factors(options, is_coarse);
  }
  double factor(const std::vector<double>& factors, int a, int b) const {
    const SeamGraph graph = SeamGraph::of(parts.pieces[0].view());
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

TEST_CASE("what looks at the viewer is dearer, up to the length of the direction") {
  const Mesh mesh = sphere(6);
  const SeamGraph graph = SeamGraph::of(mesh.view());
  SeamSuggestionOptions options;
  options.front = {0, -3, 0};
  const std::vector<double> factors = factors_of(mesh, options, numbers(mesh));
  double highest = 0;
  for (std::size_t e = 0; e < factors.size(); ++e) {
    const auto [a, b] = graph.edges()[e].vertices;
    const double y = 0.5 * (mesh.points[a].y() + mesh.points[b].y());
    CHECK(factors[e] == doctest::Approx(1 + std::max(0.0, -3 * y)).epsilon(0.15));
    highest = std::max(highest, factors[e]);
  }
  CHECK(highest > 3.9);
  CHECK(highest <= 4);
}

TEST_CASE("painted weights change the cost up to a factor of eight either way") {
  const Mesh mesh = quad_grid(2, 1);
  const SeamGraph graph = SeamGraph::of(mesh.view());
  // In the numbers of another mesh, of which this is a part.
  const std::vector<double> painted{9, 1, 1, 0, 0, -1, -1};
  SeamSuggestionOptions options;
  options.vertex_preference = painted.data();
  const std::vector<double> factors = factors_of(mesh, options, {1, 3, 5, 2, 4, 6});
  const auto factor = [&](int a, int b) { return factors[static_cast<std::size_t>(graph.find_edge(a, b))]; };
  CHECK(factor(0, 3) == doctest::Approx(0.125));
  CHECK(factor(1, 4) == doctest::Approx(1));
  CHECK(factor(2, 5) == doctest::Approx(8));
  CHECK(factor(0, 1) == doctest::Approx(1 / std::sqrt(8)));
}

TEST_CASE("for the shortest seams an edge costs its length, marked or not, times the factors of hints") {
  const TwoQuads quads;
  const std::array<int, 2> edge{11, 14};
  SeamSuggestionOptions options;
  options.shortest = true;
  options.preferred_edges = &edge;
  options.n_preferred_edges = 1;
  const SeamGraph graph = SeamGraph::of(quads.parts.pieces[0].view());
  const auto cost = [&] {
    const std::vector<double> factors = quads.factors(options, false);
    const auto inner = std::find_if(graph.edges().begin(), graph.edges().end(), [](const auto& e) { return !e.cut; });
    REQUIRE(inner != graph.edges().end());
    return inner->cost * factors[static_cast<std::size_t>(inner - graph.edges().begin())] / inner->length;
  };
  CHECK(cost() == doctest::Approx(1));
  options.avoided_edges = &edge;
  options.n_avoided_edges = 1;
  CHECK(cost() == doctest::Approx(1e6));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
