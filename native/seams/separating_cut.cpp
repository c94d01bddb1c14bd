#include "seams/separating_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "graph/maximum_flow.h"
#include "graph/shortest_paths.h"
#include "seams/trial_map.h"

namespace spectral_conformal {
namespace {

/// The minimum cut may move by this fraction of the way from the level to the sources or the sinks. On 12 meshes, half
/// of it gave 3 % longer seams at the same distortion; twice as much, 4 % shorter ones and 2 % more distortion.
constexpr double leeway = 0.3;

/// The faces in increasing order of the level function.
std::vector<int> in_order(const std::vector<double>& level) {
  std::vector<int> order(level.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return level[a] != level[b] ? level[a] < level[b] : a < b; });
  return order;
}

/// The level of the cut with the lowest cost over the root of the smaller area; NaN without one.
double best_level(const SeparableFaces& faces, const std::vector<double>& level, const std::vector<int>& order,
                  double low, double high, double min_fraction) {
  double total = 0;
  for (const int face : order) total += faces.area[face];
  std::vector<char> inside(level.size(), 0);
  double area = 0;
  double cost = 0;
  double best = infinity;
  double result = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const int face = order[i];
    poll();
    inside[face] = 1;
    area += faces.area[face];
    for (int k = faces.dual.first_arc(face); k < faces.dual.first_arc(face + 1); ++k) {
      cost += (inside[faces.dual.arc(k).to] != 0 ? -1 : 1) * faces.cost[k];
    }
    const double next = level[order[i + 1]];
    const double smaller = std::min(area, total - area);
    if (!(next > level[face]) || level[face] < low || next > high || !(smaller >= min_fraction * total)) continue;
    const double score = cost / std::sqrt(smaller);
    if (score < best) {
      best = score;
      result = 0.5 * (level[face] + next);
    }
  }
  return result;
}

}  // namespace

SeparableFaces::SeparableFaces(const SeamGraph& graph, std::vector<int> some, std::vector<double> areas,
                               std::vector<Eigen::Vector3d> centers)
    : faces(std::move(some)), area(std::move(areas)), center(std::move(centers)) {
  std::vector<std::array<int, 3>> arcs;  // from, edge, to
  arcs.reserve(3 * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    poll();
    for (const auto& [edge, to] : graph.dual().arcs(faces[f])) {
      const int other = graph.edges()[edge].cut ? -1 : index(to);
      if (other >= 0) arcs.push_back({static_cast<int>(f), edge, other});
    }
  }
  dual = Adjacency::from_arcs(static_cast<int>(faces.size()), [&](auto&& visit) {
    for (const auto& [from, edge, to] : arcs) visit(from, edge, to);
  });
  distance.reserve(arcs.size());
  cost.reserve(arcs.size());
  for (const auto& [from, edge, to] : arcs) {
    distance.push_back((center[from] - center[to]).norm());
    cost.push_back(graph.edges()[edge].cost);
  }
}

int SeparableFaces::index(int face) const {
  const auto at = std::lower_bound(faces.begin(), faces.end(), face);
  return at == faces.end() || *at != face ? -1 : static_cast<int>(at - faces.begin());
}

std::vector<double> face_distances(const SeparableFaces& faces, const std::vector<int>& sources) {
  ShortestPathSearch search(faces.dual.n_nodes());
  for (const int source : sources) search.offer(source, 0);
  for (int face = search.settle(); face >= 0; face = search.settle()) {
    poll();
    const double so_far = search.distance(face);
    for (int k = faces.dual.first_arc(face); k < faces.dual.first_arc(face + 1); ++k) {
      search.offer(faces.dual.arc(k).to, so_far + faces.distance[k]);
    }
  }
  return search.distances();
}

std::vector<std::vector<int>> connected_parts(const SeparableFaces& faces, const std::vector<int>& some) {
  std::vector<char> open(faces.size(), 0);
  for (const int face : some) open[face] = 1;
  std::vector<std::pair<double, std::vector<int>>> parts;
  for (const int seed : some) {
    if (open[seed] == 0) continue;
    open[seed] = 0;
    std::vector<int> part{seed};
    double area = 0;
    for (std::size_t head = 0; head < part.size(); ++head) {
      area += faces.area[part[head]];
      for (const auto& arc : faces.dual.arcs(part[head])) {
        if (open[arc.to] == 0) continue;
        open[arc.to] = 0;
        part.push_back(arc.to);
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
                                  const std::vector<int>& sinks, double min_fraction) {
  std::vector<char> side(faces.size(), 0);
  std::vector<double> level;
  std::vector<double> from_sinks;
  run_in_parallel(
      2,
      [&](int i, const Progress&) { (i == 0 ? level : from_sinks) = face_distances(faces, i == 0 ? sources : sinks); },
      {}, "", max_threads_for(steps_per_face * faces.size()));
  double low = -infinity;
  double high = infinity;
  for (std::size_t f = 0; f < level.size(); ++f) {
    level[f] = std::isfinite(level[f]) && std::isfinite(from_sinks[f]) ? level[f] - from_sinks[f] : infinity;
  }
  for (const int face : sources) low = std::max(low, level[face]);
  for (const int face : sinks) high = std::min(high, level[face]);
  std::vector<int> order;
  call_while_polling(steps_per_face * level.size(), [&] { order = in_order(level); });
  const double best = best_level(faces, level, order, low, high, min_fraction);
  if (std::isnan(best)) return side;

  // Nodes: 0 the source, 1 the sink, then the faces between.
  const auto at = std::partition_point(order.begin(), order.end(), [&](int face) { return level[face] < best; });
  const auto level_beside = [&](std::ptrdiff_t offset) {
    return level[*(at + std::clamp(offset, order.begin() - at, order.end() - at - 1))];
  };
  // At most large_piece / 3 faces on either side: cuts of 500,000 faces took 20 seconds each.
  const double lower = std::max(best - leeway * (best - low), level_beside(-large_piece / 3));
  const double upper = std::min(best + leeway * (high - best), level_beside(large_piece / 3));
  std::vector<int> node(level.size(), -1);
  int n_nodes = 2;
  for (const int face : order) node[face] = level[face] <= lower ? 0 : level[face] >= upper ? 1 : n_nodes++;
  std::vector<CapacityEdge> between;
  for (const int face : order) {
    for (int k = faces.dual.first_arc(face); k < faces.dual.first_arc(face + 1); ++k) {
      const int other = faces.dual.arc(k).to;
      if (face < other && node[face] != node[other]) between.push_back({node[face], node[other], faces.cost[k]});
    }
  }
  const std::vector<char> reached = min_cut_source_side(n_nodes, between, 0, 1);
  for (const int face : order) side[face] = reached[node[face]];
  return side;
}

}  // namespace spectral_conformal
