#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/signed_area.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The two splits of a quad 0 1 2 3, along the diagonals 0-2 and 1-3, in the order in which a triangulated surface
/// lists them if it has both.
constexpr std::array<std::array<int, 3>, 4> quad_splits{{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};

/// Whether the second split of a mapped quad is better, given the signed areas of the four triangles of quad_splits.
/// The better one is
///  - the one without a clockwise triangle, if there is exactly one,
///  - otherwise the one whose smaller signed area is larger, or the first if they differ only by rounding.
bool second_split_is_better(const std::array<double, 4>& signed_areas);

/// The one triangulation by which a map z (V,) is measured, drawn and counted, as ascending indices into `triangles`:
/// every whole triangle, and the better split of each quad with both (second_split_is_better). Hence a mapped quad is
/// flipped only if both splits are; a concave one is split at its reflex corner. triangle_weights: (F,), the splits of
/// a quad in a row, or empty for 1. z: positively oriented. Calls visit(t) for each of these among the first n
/// triangles.
template <class Visit>
void for_each_mapped_triangle(std::size_t n, const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z,
                              const Visit& visit) {
  const auto area = [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    return signed_area(z[a], z[b], z[c]);
  };
  for (std::size_t t = 0; t < n; ++t) {
    if (triangle_weights.empty() || !triangle_weights[t].in_both_splits()) {
      visit(t);
      continue;
    }
    const bool second = second_split_is_better({area(t), area(t + 1), area(t + 2), area(t + 3)});
    const std::size_t chosen = t + (second ? 2 : 0);
    visit(chosen);
    visit(chosen + 1);
    t += 3;
  }
}
std::vector<int> mapped_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                      const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z);

/// The triangulation that a map without flips must preserve, chosen before the map exists, as ascending indices into
/// `triangles`: every whole triangle, and the first split of each quad with both. If the first split's diagonal is an
/// edge already, which straight lines cannot draw twice, and the second's is not, it takes the second. If it has no
/// flip, neither has mapped_triangulation. triangle_weights as there.
std::vector<int> drawable_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                        const std::vector<TriangleWeight>& triangle_weights);

}  // namespace spectral_conformal
