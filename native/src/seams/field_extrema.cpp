#include "seams/field_extrema.h"

#include <algorithm>
#include <numeric>

namespace spectral_conformal {
namespace {

/// The neighbours of each vertex over the edges of the triangles, with repetitions.
struct Neighbours {
  std::vector<int> start;
  std::vector<int> vertex;

  Neighbours(std::size_t n_vertices, const std::vector<std::array<int, 3>>& triangles) : start(n_vertices + 1, 0) {
    for (const auto& triangle : triangles) {
      for (const int v : triangle) start[v + 1] += 2;
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    vertex.resize(static_cast<std::size_t>(start.back()));
    std::vector<int> fill(start.begin(), start.end() - 1);
    for (const auto& triangle : triangles) {
      for (int k = 0; k < 3; ++k) {
        vertex[fill[triangle[k]]++] = triangle[(k + 1) % 3];
        vertex[fill[triangle[k]]++] = triangle[(k + 2) % 3];
      }
    }
  }
};

/// Connected parts of the sublevel set, each named by its lowest vertex.
struct Basins {
  std::vector<int> parent;
  std::vector<double> area;
  std::vector<double> moment;  ///< sum of area x value

  explicit Basins(std::size_t n) : parent(n, -1), area(n, 0), moment(n, 0) {}
  int find(int v) {
    while (parent[v] != v) {
      parent[v] = parent[parent[v]];
      v = parent[v];
    }
    return v;
  }
};

}  // namespace

std::vector<FieldMinimum> prominent_minima(const std::vector<double>& field, const std::vector<double>& area,
                                           const std::vector<std::array<int, 3>>& triangles, double top,
                                           double prominence) {
  const Neighbours neighbours(field.size(), triangles);
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
    basins.parent[v] = v;
    basins.area[v] = area[v];
    basins.moment[v] = area[v] * field[v];
    for (int k = neighbours.start[v]; k < neighbours.start[v + 1]; ++k) {
      if (basins.parent[neighbours.vertex[k]] < 0) continue;
      int deeper = basins.find(neighbours.vertex[k]);
      int shallower = basins.find(v);
      if (deeper == shallower) continue;
      if (lower(shallower, deeper)) std::swap(deeper, shallower);
      close(shallower, field[v]);
      basins.parent[shallower] = deeper;
      basins.area[deeper] += basins.area[shallower];
      basins.moment[deeper] += basins.moment[shallower];
    }
  }
  for (const int v : order) {
    if (basins.find(v) == v) close(v, top);
  }
  std::sort(result.begin(), result.end(), [](const FieldMinimum& a, const FieldMinimum& b) {
    return a.volume != b.volume ? a.volume > b.volume : a.vertex < b.vertex;
  });
  return result;
}

}  // namespace spectral_conformal
