#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/signed_area.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The two splits of a quad 0 1 2 3, along the diagonals 0-2 and 1-3, in the order in which a triangulated surface
/// lists them where it has both.
constexpr std::array<std::array<int, 3>, 4> quad_splits{{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};

/// Of the two splits of a mapped quad, given the signed areas of their four triangles in the order of quad_splits:
///  - the one without a clockwise triangle, if only one has none,
///  - otherwise the one whose smaller signed area is larger, the first if they differ by rounding only.
bool second_split_is_better(const std::array<double, 4>& signed_areas);

/// The one triangulation by which a map z (V,) is measured, drawn and counted, as ascending indices into `triangles`:
/// every whole triangle, and of a quad with both splits the better one (second_split_is_better).
/// Hence a mapped quad is flipped only if neither split avoids it; a concave one is split at its reflex corner.
/// triangle_weights (F,), the splits of a quad in a row, or empty for 1. z positively oriented.
/// Calls visit(t) for each of these among the first n triangles.
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

/// The triangulation that a map without flips is required to keep, chosen before there is a map, as ascending indices
/// into `triangles`: every whole triangle, and of a quad with both splits the first, unless its diagonal is an
/// edge already, which no straight lines can draw twice, and that of the second is none. Where it has no flip,
/// mapped_triangulation has none. triangle_weights as there.
std::vector<int> drawable_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                        const std::vector<TriangleWeight>& triangle_weights);

}  // namespace spectral_conformal
