#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "graph/maximum_flow.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

double capacity_of(const std::vector<CapacityEdge>& edges, const std::vector<char>& side) {
  double sum = 0;
  for (const auto& edge : edges) sum += side[edge.a] != side[edge.b] ? edge.capacity : 0;
  return sum;
}

/// Of all cuts between nodes 0 and 1 the cheapest, of several the one with the smallest side.
std::vector<char> cheapest(int n_nodes, const std::vector<CapacityEdge>& edges) {
  std::vector<char> best;
  double least = std::numeric_limits<double>::infinity();
  std::ptrdiff_t size = 0;
  for (unsigned mask = 0; mask < 1U << (n_nodes - 2); ++mask) {
    std::vector<char> side{1, 0};
    for (int i = 2; i < n_nodes; ++i) side.push_back(static_cast<char>(mask >> (i - 2) & 1U));
    const double capacity = capacity_of(edges, side);
    const auto count = std::count(side.begin(), side.end(), 1);
    if (capacity > least || (capacity == least && count >= size)) continue;
    least = capacity;
    size = count;
    best = side;
  }
  return best;
}

}  // namespace

TEST_SUITE_BEGIN("maximum_flow");

TEST_CASE("the side is that of the cheapest of all cuts, the smallest where several are") {
  std::mt19937 random(7);
  for (int sample = 0; sample < 60; ++sample) {
    const int n_nodes = 8;
    std::vector<CapacityEdge> edges;
    for (int e = 0; e < 16; ++e) {
      edges.push_back({static_cast<int>(random() % n_nodes), static_cast<int>(random() % n_nodes),
                       static_cast<double>((1U << random() % 4) / 2)});
    }
    CHECK(min_cut_source_side(n_nodes, edges, 0, 1) == cheapest(n_nodes, edges));
  }
}

TEST_CASE("capacities that only rounding makes differ are equal") {
  // Of the edges in a row the first is the cut, unless another is cheaper.
  const double sum = 0.1 + 0.2;
  REQUIRE(sum > 0.3);
  CHECK(min_cut_source_side(4, {{0, 2, sum}, {2, 3, 0.3}, {3, 1, sum}}, 0, 1) == std::vector<char>{1, 0, 0, 0});
  CHECK(min_cut_source_side(4, {{0, 2, sum}, {2, 3, 0.2999}, {3, 1, sum}}, 0, 1) == std::vector<char>{1, 0, 1, 0});
}

TEST_CASE("capacities of any magnitude") {
  for (const double unit : {1e-300, 1e-9, 1.0, 1e12, 1e300}) {
    const std::vector<CapacityEdge> edges{{0, 2, 3 * unit}, {2, 3, unit}, {3, 1, 2 * unit}, {2, 1, unit / 8}};
    CHECK(min_cut_source_side(4, edges, 0, 1) == std::vector<char>{1, 0, 1, 0});
  }
}

TEST_CASE("nodes that no path joins") {
  CHECK(min_cut_source_side(4, {{0, 2, 1}, {3, 1, 1}}, 0, 1) == std::vector<char>{1, 0, 1, 0});
  CHECK(min_cut_source_side(2, {}, 0, 1) == std::vector<char>{1, 0});
  CHECK(min_cut_source_side(3, {{0, 2, 0}, {2, 1, 0}}, 0, 1) == std::vector<char>{1, 0, 0});
}

TEST_CASE("long flows are canceled") {
  // A grid between source and sink.
  constexpr int side = 300;
  std::vector<CapacityEdge> edges;
  const auto node = [](int x, int y) { return 2 + x * side + y; };
  for (int x = 0; x < side; ++x) {
    edges.push_back({0, node(0, x), side});
    edges.push_back({node(side - 1, x), 1, side});
    for (int y = 0; y + 1 < side; ++y) {
      edges.push_back({node(x, y), node(x, y + 1), 1});
      edges.push_back({node(y, x), node(y + 1, x), 1});
    }
  }
  int calls = 0;
  const Progress progress = [&](double, const char*) { return ++calls < 3; };
  const std::size_t before = exchange_poll_interval(shared_steps);
  {
    const CancellationScope scope(progress, "flow");
    CHECK_THROWS_AS(min_cut_source_side(2 + side * side, edges, 0, 1), Cancelled);
  }
  exchange_poll_interval(before);
  CHECK(calls == 3);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
