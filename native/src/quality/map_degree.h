#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// For counts of what may be visited or tested.
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
/// Pairs of boxes visited per triangle or boundary edge before a sweep, of about the same cost, takes over.
constexpr std::size_t pairs_of_each = 100;

// Where a map of a triangulated chart can overlap, deduced only from its boundary and the signs of its triangles.
//
// Let p be a point of the plane on the image of no edge, and N+ and N- the numbers of counterclockwise and clockwise
// triangles over it. N+ - N- is the degree of the map at p. It equals the sum of the winding numbers of the boundary
// loops about p, because the interior edges cancel (Lipman 2014, "Bijective mappings of meshes with boundary and the
// degree in mesh processing", SIAM J. Imaging Sci. 7). A simple polygon has winding number 0 outside and, inside, 1 if
// it runs counterclockwise and -1 if it runs clockwise. Hence:
//  - If the boundary loops are simple polygons and exactly one of them runs counterclockwise, N+ - N- <= 1. More than
//    one triangle lies over p only if a clockwise one does: every overlap involves a clockwise triangle.
//  - If, moreover, no triangle is clockwise, N+ <= 1: nothing overlaps, and the map is injective.
//  - Conversely, if the loops are simple and disjoint and the map of a connected chart is injective, its image is a
//    connected domain bounded by these loops, so exactly one runs counterclockwise.
//  - If the loops cross or touch, their winding numbers give the degree over every triangle that they avoid. Overlaps
//    lie where the degree is above 1, or where there is a clockwise triangle.
// A loop of two vertices, one edge there and back, winds around nothing and is omitted. Interior vertices with angle
// sums above 2 pi need no special care: they show at the boundary.

/// Whether the boundary proves that the degree is at most 1 everywhere: all loops are simple, disjoint polygons,
/// exactly one of them counterclockwise, by exact predicates. False if an edge has collapsed or the boundary touches
/// itself. loops: all of the chart's; z: (V,), finite. O(n log n) for n boundary edges.
bool has_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

/// The same for the boundary loops of several orientable charts, each to the left of its loops: no loop meets another,
/// and each counterclockwise loop lies where the degree of all others is at most 0. Also false if the rays that show
/// this meet more than 100 edges per boundary edge. O(n log n).
bool have_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

/// Suspect triangles, ascending: of every two overlapping triangles, one is a suspect, or both overlap a suspect.
/// Suspects are the triangles that are not counterclockwise, and, unless has_degree_at_most_one, those that the
/// boundary may cross or over which the degree is above 1. The others cover the plane at most once. triangles: those of
/// an orientable chart, one split of each quad; loops: all of the chart's; z: (V,), finite. O(n log n) for n triangles
/// and boundary edges.
std::vector<int> overlap_suspects(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

}  // namespace spectral_conformal
