#include "seams/field_extrema.h"

#include <algorithm>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "graph/disjoint_sets.h"

namespace spectral_conformal {
namespace {

/// Connected parts of the sublevel set, each with its lowest vertex as root.
struct Basins {
  DisjointSets sets;
  std::vector<char> reached;  ///< per vertex: in the sublevel set
  std::vector<double> area;
  std::vector<double> moment;  ///< sum of area x value

  explicit Basins(std::size_t n) : sets(static_cast<int>(n)), reached(n, 0), area(n, 0), moment(n, 0) {}
};

}  // namespace

std::vector<FieldMinimum> prominent_minima(const std::vector<double>& field, const std::vector<double>& area,
                                           const Adjacency& neighbors, double top, double prominence) {
  std::vector<int> order;
  for (std::size_t v = 0; v < field.size(); ++v) {
    if (field[v] < top) order.push_back(static_cast<int>(v));
  }
  const auto lower = [&](int a, int b) { return field[a] != field[b] ? field[a] < field[b] : a < b; };
  std::sort(order.begin(), order.end(), lower);

  std::vector<FieldMinimum> result;
  Basins basins(field.size());
  const auto close = [&](int basin, double level) {
    const double volume = level * basins.area[basin] - basins.moment[basin];
    if (level - field[basin] >= prominence) result.push_back({basin, level - field[basin], volume});
  };
  for (const int v : order) {
    poll();
    basins.reached[v] = 1;
    basins.area[v] = area[v];
    basins.moment[v] = area[v] * field[v];
    for (const auto& arc : neighbors.arcs(v)) {
      if (basins.reached[arc.to] == 0) continue;
      int deeper = basins.sets.find(arc.to);
      int shallower = basins.sets.find(v);
      if (deeper == shallower) continue;
      if (lower(shallower, deeper)) std::swap(deeper, shallower);
      close(shallower, field[v]);
      basins.sets.attach(shallower, deeper);
      basins.area[deeper] += basins.area[shallower];
      basins.moment[deeper] += basins.moment[shallower];
    }
  }
  for (const int v : order) {
    if (basins.sets.find(v) == v) close(v, top);
  }
  std::sort(result.begin(), result.end(), [](const FieldMinimum& a, const FieldMinimum& b) {
    return a.volume != b.volume ? a.volume > b.volume : a.vertex < b.vertex;
  });
  return result;
}

Adjacency neighbors_along(const std::vector<std::array<int, 3>>& triangles, int n_vertices) {
  return Adjacency::from_arcs(n_vertices, [&](auto&& visit) {
    for (const auto& triangle : triangles) {
      for (int k = 0; k < 3; ++k) {
        visit(triangle[k], -1, triangle[(k + 1) % 3]);
        visit(triangle[k], -1, triangle[(k + 2) % 3]);
      }
    }
  });
}

}  // namespace spectral_conformal
