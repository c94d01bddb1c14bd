#include "geometry/quad_splits.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "graph/adjacency.h"

namespace spectral_conformal {

bool second_split_is_better(const std::array<double, 4>& area) {
  const double first = std::min(area[0], area[1]);
  const double second = std::min(area[2], area[3]);
  if ((first < 0) != (second < 0)) return first < 0;
  // Both splits of a parallelogram or trapezoid have equal smaller areas.
  return second - first > insignificant * std::abs(area[0] + area[1]);
}

std::vector<int> mapped_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                      const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z) {
  std::vector<int> result;
  result.reserve(triangles.size());
  for_each_mapped_triangle(triangles.size(), triangles, triangle_weights, z,
                           [&](std::size_t t) { result.push_back(static_cast<int>(t)); });
  poll(triangles.size());
  return result;
}

std::vector<int> drawable_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                        const std::vector<TriangleWeight>& triangle_weights) {
  const auto is_first_of_quad = [&](std::size_t t) {
    return !triangle_weights.empty() && triangle_weights[t].in_both_splits();
  };
  std::vector<int> result;
  result.reserve(triangles.size());
  bool has_quads = false;
  for (std::size_t t = 0; t < triangles.size() && !has_quads; ++t) {
    has_quads = is_first_of_quad(t);
    if (!has_quads) result.push_back(static_cast<int>(t));
  }
  if (!has_quads) return result;
  result.clear();
  std::set<std::array<int, 2>> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    poll();  // of a large set
    edges.insert({edge_between(a, b), edge_between(b, c)});
    if (!is_first_of_quad(t)) {
      edges.insert(edge_between(c, a));
      continue;
    }
    const int d = triangles[t + 1][2];
    edges.insert({edge_between(c, d), edge_between(d, a)});
    t += 3;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!is_first_of_quad(t)) {
      result.push_back(static_cast<int>(t));
      continue;
    }
    poll();
    const auto first_diagonal = edge_between(triangles[t][0], triangles[t][2]);
    const auto second_diagonal = edge_between(triangles[t][1], triangles[t + 1][2]);
    const bool second = edges.count(first_diagonal) > 0 && edges.count(second_diagonal) == 0;
    edges.insert(second ? second_diagonal : first_diagonal);
    const int chosen = static_cast<int>(t) + (second ? 2 : 0);
    result.insert(result.end(), {chosen, chosen + 1});
    t += 3;
  }
  return result;
}

}  // namespace spectral_conformal
