#include "graph/maximum_flow.h"

#if defined(__GNUC__) && !defined(__clang__)
// Boost assigns iterators and edge descriptors after their construction, which GCC cannot follow.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {
namespace {

// Flow is integral: rounding residuals of sums of doubles would let the source seem to reach nodes beyond a minimum
// cut.
using Amount = std::int64_t;
using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;

struct Node {
  boost::default_color_type color = boost::white_color;
  int distance = 0;
  Traits::edge_descriptor predecessor;
};
struct Arc {
  Amount capacity = 0;
  Amount residual = 0;
  Traits::edge_descriptor reverse;
};
using FlowGraph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Node, Arc>;

/// The residual capacities. Looks at them are the steps of a flow.
struct PolledResiduals {
  using key_type = Traits::edge_descriptor;
  using value_type = Amount;
  using reference = Amount;
  using category = boost::read_write_property_map_tag;
  FlowGraph* graph;
  std::size_t* looks;  ///< not counted by poll yet
};
Amount get(const PolledResiduals& residuals, const Traits::edge_descriptor& arc) {
  constexpr std::size_t many = 1024;  // a look takes about as long as a poll
  if (++*residuals.looks == many) poll(std::exchange(*residuals.looks, 0));
  return (*residuals.graph)[arc].residual;
}
void put(const PolledResiduals& residuals, const Traits::edge_descriptor& arc, Amount amount) {
  (*residuals.graph)[arc].residual = amount;
}

void connect(FlowGraph& graph, int a, int b, Amount capacity) {
  const auto there = add_edge(a, b, graph).first;
  const auto back = add_edge(b, a, graph).first;
  graph[there] = {capacity, 0, back};
  graph[back] = {capacity, 0, there};
}

}  // namespace

std::vector<char> min_cut_source_side(int n_nodes, const std::vector<CapacityEdge>& edges, int source, int sink) {
  double max_capacity = 0;
  for (const CapacityEdge& edge : edges) max_capacity = std::max(max_capacity, edge.capacity);
  // The largest capacity is 2^40 units, so that edges of a regular mesh, equally long up to rounding (1e-12), carry the
  // same amount; it is smaller where needed to keep the total below 2^61.
  const double n_units = std::min(std::ldexp(1.0, 40), std::ldexp(1.0, 61) / static_cast<double>(edges.size() + 1));
  const auto units = [&](double capacity) -> Amount {
    return max_capacity > 0 ? std::llround(capacity / max_capacity * n_units) : 0;
  };
  FlowGraph graph(static_cast<std::size_t>(n_nodes));
  for (const CapacityEdge& edge : edges) connect(graph, edge.a, edge.b, units(edge.capacity));
  std::size_t looks = 0;
  boost::boykov_kolmogorov_max_flow(graph, get(&Arc::capacity, graph), PolledResiduals{&graph, &looks},
                                    get(&Arc::reverse, graph), get(&Node::predecessor, graph), get(&Node::color, graph),
                                    get(&Node::distance, graph), get(boost::vertex_index, graph), source, sink);
  std::vector<char> side(static_cast<std::size_t>(n_nodes), 0);
  std::vector<int> reached{source};
  side[source] = 1;
  for (std::size_t head = 0; head < reached.size(); ++head) {
    for (auto [arc, end] = out_edges(reached[head], graph); arc != end; ++arc) {
      const auto to = target(*arc, graph);
      if (side[to] != 0 || graph[*arc].residual <= 0) continue;
      side[to] = 1;
      reached.push_back(static_cast<int>(to));
    }
  }
  return side;
}

}  // namespace spectral_conformal
