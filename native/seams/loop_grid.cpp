#include "seams/loop_grid.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {
namespace {

/// The loops of one family that cross a loop, in order along it. Empty unless each loop of their family does once.
std::vector<int> crossing(const SeamGraph& graph, const EdgeLoops& loops, int loop) {
  const std::vector<int>& edges = loops.loops[loop];
  std::vector<int> result;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    poll();
    const int vertex = graph.common_vertex(edges[i], edges[(i + 1) % edges.size()]);
    int other = -1;
    for (const auto& arc : graph.adjacency().arcs(vertex)) {
      if (loops.loop_of[arc.edge] != loop) other = loops.loop_of[arc.edge];
    }
    if (other < 0 || loops.family[other] == loops.family[loop]) return {};
    if (!result.empty() && loops.family[other] != loops.family[result.front()]) return {};
    result.push_back(other);
  }
  if (result.empty()) return {};
  std::vector<int> each = result;
  std::sort(each.begin(), each.end());
  const auto of_family = std::count(loops.family.begin(), loops.family.end(), loops.family[result.front()]);
  const bool is_once = std::adjacent_find(each.begin(), each.end()) == each.end();
  return is_once && of_family == static_cast<std::ptrdiff_t>(each.size()) ? result : std::vector<int>{};
}

}  // namespace

std::vector<LoopGrid> LoopGrid::of(const SeamGraph& graph, const EdgeLoops& loops) {
  std::vector<LoopGrid> result;
  std::vector<char> is_known(loops.loops.size(), 0);  // by family
  for (int loop = 0; loop < static_cast<int>(loops.loops.size()); ++loop) {
    if (is_known[loops.family[loop]] != 0) continue;
    is_known[loops.family[loop]] = 1;
    LoopGrid grid;
    grid.families[1] = crossing(graph, loops, loop);
    if (grid.families[1].empty()) continue;
    grid.families[0] = crossing(graph, loops, grid.families[1].front());
    if (grid.families[0].empty() || loops.family[grid.families[0].front()] != loops.family[loop]) continue;
    is_known[loops.family[grid.families[1].front()]] = 1;
    result.push_back(std::move(grid));
  }
  return result;
}

std::vector<std::vector<int>> evenly_spaced(const std::vector<int>& family, int count,
                                            const std::vector<double>& costs) {
  const auto n = static_cast<int>(family.size());
  const auto from = [&](int first) {
    std::vector<int> loops;
    loops.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) loops.push_back(family[(first + k * n / count) % n]);
    return loops;
  };
  const int period = n / std::gcd(n, count);  // a shift by it gives the same loops
  std::pair<double, int> cheapest{infinity, 0};
  for (int first = 0; first < period; ++first) {
    const std::vector<int> loops = from(first);
    poll(loops.size());
    const auto add = [&](double sum, int loop) { return sum + costs[loop]; };
    cheapest = std::min(cheapest, {std::accumulate(loops.begin(), loops.end(), 0.0, add), first});
  }
  std::vector<std::vector<int>> result{from(cheapest.second)};
  const auto is_alike = [&](int loop) { return costs[loop] == costs[family.front()]; };
  if (std::all_of(family.begin(), family.end(), is_alike)) return result;
  for (int quarter = 1; quarter < 4; ++quarter) {
    const int shift = quarter * period / 4;
    if (shift > (quarter - 1) * period / 4) result.push_back(from(cheapest.second + shift));
  }
  return result;
}

}  // namespace spectral_conformal
