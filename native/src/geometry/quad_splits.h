#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The two splits of a quad 0 1 2 3, along the diagonals 0-2 and 1-3, in the order in which a triangulated surface
/// lists them where it has both.
constexpr std::array<std::array<int, 3>, 4> quad_splits{{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};

/// The weight of the triangles of a quad with both splits, so that the quad counts once. Every other triangle has
/// weight 1.
constexpr double quad_split_weight = 0.5;

/// Whether a triangle is the first of four in a row that are the two splits of a quad.
inline bool begins_quad(double triangle_weight) { return triangle_weight == quad_split_weight; }

/// Of the two splits of a mapped quad, given the signed areas of their four triangles in the order of quad_splits:
///  - the one without a clockwise triangle, if only one has none,
///  - otherwise the one whose smaller signed area is larger, the first if they differ by rounding only.
bool second_split_is_better(const std::array<double, 4>& signed_areas);

/// The one triangulation by which a map z (V,) is measured, drawn and counted, as ascending indices into `triangles`:
/// every triangle of weight 1, and of a quad with both splits the better one (second_split_is_better).
/// Hence a mapped quad is flipped only if neither split avoids it; a concave one is split at its reflex corner.
/// triangle_weights (F,) or empty for 1. z positively oriented.
std::vector<int> mapped_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                      const std::vector<double>& triangle_weights, const ComplexVector& z);

/// The triangulation that a map without flips is required to keep, chosen before there is a map, as ascending indices
/// into `triangles`: every triangle of weight 1, and of a quad with both splits the first, unless its diagonal is an
/// edge already, which no straight lines can draw twice, and that of the second is none. Where it has no flip,
/// mapped_triangulation has none. triangle_weights as there.
std::vector<int> drawable_triangulation(const std::vector<std::array<int, 3>>& triangles,
                                        const std::vector<double>& triangle_weights);

}  // namespace spectral_conformal
