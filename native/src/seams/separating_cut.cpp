#include "seams/separating_cut.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace spectral_conformal {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// The minimum cut may move by this part of the way from the level to the sources or the sinks.
constexpr double leeway = 0.3;

struct Neighbour {
  int face;
  int edge;
};

/// Faces on both sides of the edges that are not cut.
std::vector<std::vector<Neighbour>> dual_graph(const SeparableFaces& faces) {
  std::vector<std::vector<Neighbour>> result(faces.member.size());
  const auto& edges = faces.graph->edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].cut) continue;
    const auto [a, b] = edges[e].faces;
    if (faces.member[a] == 0 || faces.member[b] == 0) continue;
    result[a].push_back({b, static_cast<int>(e)});
    result[b].push_back({a, static_cast<int>(e)});
  }
  return result;
}

std::vector<double> distances(const SeparableFaces& faces, const std::vector<std::vector<Neighbour>>& dual,
                              const std::vector<int>& sources) {
  using Item = std::pair<double, int>;
  std::vector<double> distance(dual.size(), infinite);
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (const int source : sources) {
    distance[source] = 0;
    queue.emplace(0.0, source);
  }
  while (!queue.empty()) {
    const auto [d, face] = queue.top();
    queue.pop();
    if (d > distance[face]) continue;
    for (const auto& [other, edge] : dual[face]) {
      const double through = d + (faces.centre[face] - faces.centre[other]).norm();
      if (!(through < distance[other])) continue;
      distance[other] = through;
      queue.emplace(through, other);
    }
  }
  return distance;
}

/// Maximum flow between two nodes of an undirected graph (Dinic's algorithm).
class Flow {
 public:
  explicit Flow(int n_nodes) : out_(static_cast<std::size_t>(n_nodes)) {}
  void connect(int a, int b, double capacity) {
    out_[a].push_back(static_cast<int>(links_.size()));
    links_.push_back({b, capacity});
    out_[b].push_back(static_cast<int>(links_.size()));
    links_.push_back({a, capacity});
    largest_ = std::max(largest_, capacity);
  }
  /// Nodes that the source still reaches when the flow is as large as it can be: the smallest of the cheapest sides.
  std::vector<char> source_side(int source, int sink) {
    while (reach(source, sink)) {
      next_.assign(out_.size(), 0);
      while (push(source, sink)) {
      }
    }
    std::vector<char> side(out_.size());
    for (std::size_t i = 0; i < side.size(); ++i) side[i] = level_[i] >= 0 ? 1 : 0;
    return side;
  }

 private:
  struct Link {
    int to;
    double left;
  };
  bool open(int link) const { return links_[link].left > 1e-12 * largest_; }

  bool reach(int source, int sink) {
    level_.assign(out_.size(), -1);
    level_[source] = 0;
    std::vector<int> queue{source};
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const int link : out_[queue[head]]) {
        const int to = links_[link].to;
        if (level_[to] >= 0 || !open(link)) continue;
        level_[to] = level_[queue[head]] + 1;
        queue.push_back(to);
      }
    }
    return level_[sink] >= 0;
  }

  /// Sends flow along one way of rising levels; false where there is none left.
  bool push(int source, int sink) {
    std::vector<int> way;
    int node = source;
    while (node != sink) {
      if (next_[node] == out_[node].size()) {
        if (way.empty()) return false;
        node = links_[way.back() ^ 1].to;
        way.pop_back();
        ++next_[node];
        continue;
      }
      const int link = out_[node][next_[node]];
      if (open(link) && level_[links_[link].to] == level_[node] + 1) {
        way.push_back(link);
        node = links_[link].to;
      } else {
        ++next_[node];
      }
    }
    double amount = infinite;
    for (const int link : way) amount = std::min(amount, links_[link].left);
    for (const int link : way) {
      links_[link].left -= amount;
      links_[link ^ 1].left += amount;
    }
    return true;
  }

  std::vector<std::vector<int>> out_;
  std::vector<Link> links_;
  std::vector<int> level_;
  std::vector<std::size_t> next_;
  double largest_ = 0;
};

/// The members in rising order of the level function.
std::vector<int> in_order(const SeparableFaces& faces, const std::vector<double>& level) {
  std::vector<int> order;
  for (std::size_t f = 0; f < level.size(); ++f) {
    if (faces.member[f] != 0) order.push_back(static_cast<int>(f));
  }
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return level[a] != level[b] ? level[a] < level[b] : a < b; });
  return order;
}

/// The level of the cut with the lowest cost for its area, or a value that is not a number.
double best_level(const SeparableFaces& faces, const std::vector<std::vector<Neighbour>>& dual,
                  const std::vector<double>& level, const std::vector<int>& order, double low, double high,
                  double least_share) {
  double total = 0;
  for (const int face : order) total += faces.area[face];
  std::vector<char> inside(level.size(), 0);
  double area = 0;
  double cost = 0;
  double best = infinite;
  double result = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const int face = order[i];
    inside[face] = 1;
    area += faces.area[face];
    for (const auto& [other, edge] : dual[face]) {
      cost += (inside[other] != 0 ? -1 : 1) * faces.graph->edges()[edge].cost;
    }
    const double next = level[order[i + 1]];
    const double smaller = std::min(area, total - area);
    if (!(next > level[face]) || level[face] < low || next > high || !(smaller >= least_share * total)) continue;
    const double score = cost / std::sqrt(smaller);
    if (score < best) {
      best = score;
      result = 0.5 * (level[face] + next);
    }
  }
  return result;
}

}  // namespace

std::vector<double> face_distances(const SeparableFaces& faces, const std::vector<int>& sources) {
  return distances(faces, dual_graph(faces), sources);
}

std::vector<std::vector<int>> connected_parts(const SeparableFaces& faces, const std::vector<int>& some) {
  const auto dual = dual_graph(faces);
  std::vector<char> open(faces.member.size(), 0);
  for (const int face : some) open[face] = 1;
  std::vector<std::pair<double, std::vector<int>>> parts;
  for (const int seed : some) {
    if (open[seed] == 0) continue;
    open[seed] = 0;
    std::vector<int> part{seed};
    double area = 0;
    for (std::size_t head = 0; head < part.size(); ++head) {
      area += faces.area[part[head]];
      for (const auto& [other, edge] : dual[part[head]]) {
        if (open[other] == 0) continue;
        open[other] = 0;
        part.push_back(other);
      }
    }
    parts.emplace_back(-area, std::move(part));
  }
  std::sort(parts.begin(), parts.end());
  std::vector<std::vector<int>> result;
  result.reserve(parts.size());
  for (auto& part : parts) result.push_back(std::move(part.second));
  return result;
}

std::vector<char> separating_side(const SeparableFaces& faces, const std::vector<int>& sources,
                                  const std::vector<int>& sinks, double least_share) {
  std::vector<char> side(faces.member.size(), 0);
  const auto dual = dual_graph(faces);
  std::vector<double> level = distances(faces, dual, sources);
  const std::vector<double> from_sinks = distances(faces, dual, sinks);
  double low = -infinite;
  double high = infinite;
  for (std::size_t f = 0; f < level.size(); ++f) {
    level[f] = faces.member[f] != 0 && std::isfinite(level[f]) && std::isfinite(from_sinks[f])
                   ? level[f] - from_sinks[f]
                   : infinite;
  }
  for (const int face : sources) low = std::max(low, level[face]);
  for (const int face : sinks) high = std::min(high, level[face]);
  const std::vector<int> order = in_order(faces, level);
  const double best = best_level(faces, dual, level, order, low, high, least_share);
  if (std::isnan(best)) return side;

  // Nodes: 0 the source, 1 the sink, then the faces between.
  const double lower = best - leeway * (best - low);
  const double upper = best + leeway * (high - best);
  std::vector<int> node(level.size(), -1);
  int n_nodes = 2;
  for (const int face : order) node[face] = level[face] <= lower ? 0 : level[face] >= upper ? 1 : n_nodes++;
  Flow flow(n_nodes);
  for (const int face : order) {
    for (const auto& [other, edge] : dual[face]) {
      if (face < other && node[face] != node[other]) {
        flow.connect(node[face], node[other], faces.graph->edges()[edge].cost);
      }
    }
  }
  const std::vector<char> reached = flow.source_side(0, 1);
  for (const int face : order) side[face] = reached[node[face]];
  return side;
}

}  // namespace spectral_conformal
