#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "graph/adjacency.h"

namespace spectral_conformal::test {
namespace {

std::vector<std::array<int, 2>> arcs_of(const Adjacency& graph, int node) {
  std::vector<std::array<int, 2>> result;
  for (const auto& arc : graph.arcs(node)) result.push_back({arc.edge, arc.to});
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("adjacency");

TEST_CASE("every edge leaves both of its nodes, in the edges' order") {
  const Adjacency graph(4, {{2, 0}, {0, 1}, {0, 2}});
  CHECK(graph.n_nodes() == 4);
  CHECK(graph.n_arcs() == 6);
  CHECK(arcs_of(graph, 0) == std::vector<std::array<int, 2>>{{0, 2}, {1, 1}, {2, 2}});
  CHECK(arcs_of(graph, 1) == std::vector<std::array<int, 2>>{{1, 0}});
  CHECK(arcs_of(graph, 2) == std::vector<std::array<int, 2>>{{0, 0}, {2, 0}});
  CHECK(arcs_of(graph, 3).empty());
  for (int node = 0; node < 4; ++node) {
    int k = graph.first_arc(node);
    for (const auto& arc : graph.arcs(node)) CHECK(&arc == &graph.arc(k++));
    CHECK(k == graph.first_arc(node + 1));
  }
}

TEST_CASE("arcs may have one direction and keep their order at each node") {
  const Adjacency graph = Adjacency::from_arcs(3, [](auto&& visit) {
    visit(1, 7, 2);
    visit(0, 5, 0);
    visit(1, 6, 0);
  });
  CHECK(arcs_of(graph, 0) == std::vector<std::array<int, 2>>{{5, 0}});
  CHECK(arcs_of(graph, 1) == std::vector<std::array<int, 2>>{{7, 2}, {6, 0}});
  CHECK(arcs_of(graph, 2).empty());
}

TEST_CASE("the edges of a matrix's graph are its entries below the diagonal") {
  HermitianMatrix matrix(3, 3);
  matrix.insert(0, 0) = 2;
  matrix.insert(2, 0) = Complex(1, 1);
  matrix.insert(1, 1) = 2;
  matrix.insert(2, 1) = -1;
  matrix.insert(2, 2) = 2;
  matrix.makeCompressed();
  const Adjacency graph = graph_of(matrix);
  CHECK(arcs_of(graph, 0) == std::vector<std::array<int, 2>>{{1, 2}});
  CHECK(arcs_of(graph, 1) == std::vector<std::array<int, 2>>{{3, 2}});
  CHECK(arcs_of(graph, 2) == std::vector<std::array<int, 2>>{{1, 0}, {3, 1}});
}

TEST_CASE("a graph without nodes") {
  CHECK(Adjacency().n_nodes() == 0);
  CHECK(Adjacency(0, {}).n_arcs() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
