#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "graph/vertex_separator.h"

namespace spectral_conformal::test {
namespace {

std::vector<char> members(int n, const std::vector<int>& nodes) {
  std::vector<char> result(static_cast<std::size_t>(n), 0);
  for (const int node : nodes) result[static_cast<std::size_t>(node)] = 1;
  return result;
}

int size_of(const std::vector<SeparatorSide>& side) {
  return static_cast<int>(std::count(side.begin(), side.end(), SeparatorSide::separator));
}

/// Whether no walk from a source to a sink is left without the nodes whose bit is set.
bool separates(const Adjacency& graph, const std::vector<char>& sources, const std::vector<char>& sinks,
               unsigned taken) {
  const auto is_taken = [taken](int node) { return (taken >> static_cast<unsigned>(node) & 1U) != 0; };
  std::vector<char> seen(sources.size(), 0);
  std::vector<int> reached;
  const auto reach = [&](int node) {
    if (is_taken(node) || seen[static_cast<std::size_t>(node)]) return;
    seen[static_cast<std::size_t>(node)] = 1;
    reached.push_back(node);
  };
  for (int node = 0; node < graph.n_nodes(); ++node) {
    if (sources[static_cast<std::size_t>(node)]) reach(node);
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (sinks[static_cast<std::size_t>(reached[i])]) return false;
    for (const auto& arc : graph.arcs(reached[i])) reach(arc.to);
  }
  return true;
}

int n_bits(unsigned bits) {
  int n = 0;
  for (; bits != 0; bits &= bits - 1) ++n;
  return n;
}

}  // namespace

TEST_SUITE_BEGIN("vertex_separator");

TEST_CASE("a grid is parted across its waist") {
  // Rows of 5 nodes, 3 in the middle one.
  constexpr int n = 23;
  std::vector<std::array<int, 2>> edges;
  const std::vector<std::vector<int>> rows{
      {0, 1, 2, 3, 4}, {5, 6, 7, 8, 9}, {-1, 10, 11, 12, -1}, {13, 14, 15, 16, 17}, {18, 19, 20, 21, 22}};
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      if (rows[i][j] < 0) continue;
      if (i < 4 && rows[i + 1][j] >= 0) edges.push_back({rows[i][j], rows[i + 1][j]});
      if (j < 4 && rows[i][j + 1] >= 0) edges.push_back({rows[i][j], rows[i][j + 1]});
    }
  }
  const auto side = smallest_vertex_separator(Adjacency(n, edges), members(n, rows.front()), members(n, rows.back()));
  CHECK(size_of(side) == 3);
  // Of all such sets the one that is nearest to the sources.
  for (const int node : {2, 6, 8}) CHECK(side[node] == SeparatorSide::separator);
  for (const int node : {0, 1, 3, 4, 5, 9}) CHECK(side[node] == SeparatorSide::source);
  CHECK(std::count(side.begin(), side.end(), SeparatorSide::sink) == n - 9);
}

TEST_CASE("of random graphs none smaller parts sources from sinks") {
  std::mt19937 random(5);
  const auto below = [&random](unsigned n) { return static_cast<int>(random() % n); };
  for (int round = 0; round < 300; ++round) {
    const int n = 2 + below(8);
    std::vector<std::array<int, 2>> edges;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < a; ++b) {
        if (below(10) < 4) edges.push_back({a, b});
      }
    }
    const Adjacency graph(n, edges);
    std::vector<char> sources = members(n, {});
    std::vector<char> sinks = sources;
    for (int node = 0; node < n; ++node) {
      sources[node] = below(4) == 0;
      sinks[node] = below(4) == 0;
    }
    int fewest = n;
    for (unsigned taken = 0; taken < 1U << static_cast<unsigned>(n); ++taken) {
      if (n_bits(taken) < fewest && separates(graph, sources, sinks, taken)) fewest = n_bits(taken);
    }
    const auto side = smallest_vertex_separator(graph, sources, sinks);
    CHECK(size_of(side) == fewest);
    unsigned taken = 0;
    for (int node = 0; node < n; ++node) {
      if (side[node] == SeparatorSide::separator) taken |= 1U << static_cast<unsigned>(node);
      if (sources[node]) CHECK(side[node] != SeparatorSide::sink);
      if (sinks[node]) CHECK(side[node] != SeparatorSide::source);
    }
    CHECK(separates(graph, sources, sinks, taken));
    for (const auto& [a, b] : edges) {
      CHECK_FALSE((side[a] == SeparatorSide::source && side[b] == SeparatorSide::sink));
      CHECK_FALSE((side[b] == SeparatorSide::source && side[a] == SeparatorSide::sink));
    }
  }
}

TEST_CASE("nothing parts what is not joined, and no node is needed without sources") {
  CHECK(size_of(smallest_vertex_separator(Adjacency(2, {}), {1, 0}, {0, 1})) == 0);
  CHECK(size_of(smallest_vertex_separator(Adjacency(2, {{0, 1}}), {0, 0}, {0, 1})) == 0);
  CHECK(smallest_vertex_separator(Adjacency(0, {}), {}, {}).empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
