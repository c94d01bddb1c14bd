#include "seams/handle_cuts.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"
#include "graph/disjoint_sets.h"
#include "seams/cut_surface.h"

namespace spectral_conformal {
namespace {

/// `edge`, and the edges on exactly one of the paths from its ends to the root; without cut edges.
std::vector<int> loop_through(const SeamGraph& graph, const std::vector<int>& parent, int edge) {
  std::set<int> loop{edge};
  for (int v : graph.edges()[edge].vertices) {
    while (parent[v] >= 0) {
      const int step = parent[v];
      count_steps(1);
      poll();
      if (!loop.insert(step).second) loop.erase(step);
      v = graph.edges()[step].other_end(v);
    }
  }
  std::vector<int> result;
  std::copy_if(loop.begin(), loop.end(), std::back_inserter(result), [&](int e) { return !graph.edges()[e].cut; });
  return result;
}

double cost_with_turns(const SeamGraph& graph, const std::vector<int>& edges) {
  double cost = graph.turning(edges);
  for (const int edge : edges) cost += graph.edges()[edge].cost;
  return cost;
}

/// Cheapest first; loops of equal cost keep their order.
void sort_by_cost(const SeamGraph& graph, std::vector<std::vector<int>>& loops) {
  std::vector<std::pair<double, std::vector<int>>> costs;
  costs.reserve(loops.size());
  for (auto& loop : loops) {
    const double cost = cost_with_turns(graph, loop);
    costs.emplace_back(cost, std::move(loop));
  }
  std::stable_sort(costs.begin(), costs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < loops.size(); ++i) loops[i] = std::move(costs[i].second);
}

/// The cheapest edge loop of every family: with any of them, the others would separate the surface.
std::vector<std::vector<int>> cheapest_loops(const SeamGraph& graph) {
  EdgeLoops found = EdgeLoops::of(graph);
  std::vector<std::pair<double, int>> best(found.loops.size(), {infinity, -1});
  for (std::size_t i = 0; i < found.loops.size(); ++i) {
    auto& of_family = best[found.family[i]];
    of_family = std::min(of_family, std::make_pair(cost_with_turns(graph, found.loops[i]), static_cast<int>(i)));
  }
  std::vector<std::vector<int>> result;
  for (const auto& [cost, loop] : best) {
    if (loop >= 0) result.push_back(std::move(found.loops[loop]));
  }
  return result;
}

/// The closed curves of edges that are their own mirror images, if exactly two of these meet at every vertex.
std::vector<std::vector<int>> self_mirrored_loops(const SeamGraph& graph, const std::function<int(int)>& mirror_edge) {
  const int n_edges = static_cast<int>(graph.edges().size());
  std::vector<int> degree(static_cast<std::size_t>(graph.n_vertices()), 0);
  DisjointSets sets(graph.n_vertices());
  std::vector<int> own;
  for (int e = 0; e < n_edges; ++e) {
    poll();
    if (graph.edges()[e].cut || mirror_edge(e) != e) continue;
    own.push_back(e);
    for (const int v : graph.edges()[e].vertices) ++degree[v];
    sets.unite(graph.edges()[e].vertices[0], graph.edges()[e].vertices[1]);
  }
  std::vector<std::vector<int>> parts(static_cast<std::size_t>(graph.n_vertices()));
  for (const int e : own) parts[sets.find(graph.edges()[e].vertices[0])].push_back(e);
  std::vector<std::vector<int>> loops;
  for (auto& part : parts) {
    const bool closed = std::all_of(part.begin(), part.end(), [&](int e) {
      return degree[graph.edges()[e].vertices[0]] == 2 && degree[graph.edges()[e].vertices[1]] == 2;
    });
    if (!part.empty() && closed) loops.push_back(std::move(part));
  }
  return loops;
}

/// Cuts along the loops that open handles, in order, and adds these to `cuts`. Earlier cuts may reduce a loop to a path
/// between them. With `may_join`, such a path may join the boundaries at its ends without opening a handle yet. A
/// complete set of generators then leaves no handle: cut along them all, the surface is a disk, with or without holes.
void cut_along(CutSurface& surface, const std::vector<std::vector<int>>& loops, bool may_join,
               std::vector<std::vector<int>>& cuts) {
  for (std::size_t n = cuts.size() + 1; surface.handle_curves() > 0 && cuts.size() != n;) {
    n = cuts.size();
    for (const auto& loop : loops) {
      if (surface.handle_curves() == 0) return;
      if (!loop.empty() && surface.try_cut(loop, may_join)) cuts.push_back(loop);
    }
  }
}

}  // namespace

std::vector<std::vector<int>> generator_loops(const SeamGraph& graph, int n_faces, int base) {
  const auto& edges = graph.edges();
  const int n_edges = static_cast<int>(edges.size());
  std::vector<int> parent;
  const std::vector<double> distance = graph.distances(
      {base}, [](int) { return true; }, &parent);
  std::vector<char> in_tree(edges.size(), 0);
  for (const int edge : parent) {
    if (edge >= 0) in_tree[edge] = 1;
  }
  // Each connected set of cuts is closed by a cap, an extra face in the dual graph.
  DisjointSets cuts(graph.n_vertices());
  for (const auto& edge : edges) {
    if (edge.cut) cuts.unite(edge.vertices[0], edge.vertices[1]);
  }
  DisjointSets cotree(n_faces + graph.n_vertices());
  const auto join = [&](int e) {
    const auto& edge = edges[e];
    if (!edge.cut) return cotree.unite(edge.faces[0], edge.faces[1]);
    bool joined = false;
    for (const int face : edge.faces) {
      if (face >= 0 && cotree.unite(face, n_faces + cuts.find(edge.vertices[0]))) joined = true;
    }
    return joined;
  };
  std::vector<int> order;
  for (int e = 0; e < n_edges; ++e) {
    if (in_tree[e] == 0) order.push_back(e);
  }
  const auto loop_length = [&](int e) {
    return distance[edges[e].vertices[0]] + distance[edges[e].vertices[1]] + edges[e].cost;
  };
  call_while_polling(order.size(), [&] {
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return loop_length(a) != loop_length(b) ? loop_length(a) > loop_length(b) : a < b; });
  });
  std::vector<std::vector<int>> loops;
  for (const int e : order) {
    poll();
    if (!join(e)) loops.push_back(loop_through(graph, parent, e));
  }
  std::reverse(loops.begin(), loops.end());
  return loops;
}

std::vector<std::vector<int>> handle_cuts(const PolygonMesh& mesh, const SeamGraph& graph,
                                          const std::function<int(int edge)>& mirror_edge) {
  const ChartDecomposition decomposition = build_charts(mesh);
  std::vector<std::vector<int>> result;
  if (decomposition.charts.size() != 1) return result;
  CutSurface surface = CutSurface::of(mesh, graph);
  if (surface.handle_curves() == 0) return result;
  const int far = graph.farthest_vertex(graph.edges().front().vertices[0], [](int) { return true; });
  const std::vector<std::vector<int>> generators = generator_loops(graph, mesh.n_faces, far);
  std::vector<std::vector<int>> loops = self_mirrored_loops(graph, mirror_edge);
  for (auto& loop : cheapest_loops(graph)) loops.push_back(std::move(loop));
  loops.insert(loops.end(), generators.begin(), generators.end());
  sort_by_cost(graph, loops);
  for (const bool mirrored : {true, false}) {
    for (const auto& loop : loops) {
      if (surface.handle_curves() == 0) return result;
      std::set<int> cut(loop.begin(), loop.end());
      for (const int edge : loop) {
        const int image = mirrored ? mirror_edge(edge) : -1;
        if (image >= 0) cut.insert(image);
      }
      std::vector<int> edges(cut.begin(), cut.end());
      if (!edges.empty() && surface.try_cut(edges)) result.push_back(std::move(edges));
    }
  }
  cut_along(surface, loops, true, result);
  if (surface.handle_curves() == 0) return result;
  // Images may block other loops: start again without them.
  CutSurface uncut = CutSurface::of(mesh, graph);
  std::vector<std::vector<int>> without_images;
  cut_along(uncut, generators, false, without_images);
  cut_along(uncut, generators, true, without_images);
  return uncut.handle_curves() < surface.handle_curves() ? without_images : result;
}

}  // namespace spectral_conformal
