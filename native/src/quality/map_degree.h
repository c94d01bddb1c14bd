#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

// Where a map of a triangulated chart can overlap, deduced from its boundary and the signs of its triangles alone.
//
// Let p be a point of the plane that is the image of no edge, and N+ and N- the numbers of counter-clockwise and
// clockwise triangles over it. N+ - N- is the degree of the map at p, which is the sum of the winding numbers of the
// boundary loops about p, because the edges within the chart cancel (Lipman 2014, "Bijective mappings of meshes with
// boundary and the degree in mesh processing", SIAM J. Imaging Sci. 7). A simple polygon has winding number 0 outside
// and, inside, 1 if it runs counter-clockwise and -1 if it runs clockwise. Hence:
//  - Where the boundary loops are simple polygons and exactly one of them runs counter-clockwise, N+ - N- <= 1. More
//    than one triangle lies over p only where a clockwise one does: what overlaps, overlaps a clockwise triangle.
//  - If moreover no triangle is clockwise, N+ <= 1: nothing overlaps, the map is injective.
//  - Conversely, if the loops are simple and disjoint and the map of a connected chart is injective, its image is a
//    connected domain whose boundary these loops are, so that exactly one runs counter-clockwise.
//  - Where the loops cross or touch, the winding numbers tell the degree over every triangle that they stay off. What
//    overlaps lies where the degree is above 1, or where a clockwise triangle is.
// A loop of two vertices, one edge there and back, winds round nothing and is left out.
// Interior vertices with angles of more than 2 pi need no care: they show at the boundary.

/// Whether the boundary proves that the degree is at most 1 everywhere: all loops are simple, disjoint polygons,
/// exactly one of them counter-clockwise, by exact predicates. False where an edge has collapsed and where the boundary
/// touches itself. loops: all of the chart's; z (V,), finite. O(n log n) for n boundary edges.
bool has_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

/// The same for the boundary loops of several orientable charts, each to the left of its loops: no loop meets another,
/// and each that runs counter-clockwise lies where the degree of all others is at most 0. False too where this takes
/// more than 100 times as many comparisons as there are boundary edges. O(n log n).
bool have_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

/// Triangles, ascending, of which every two that overlap have one between them, or both overlap one: those that are not
/// counter-clockwise, and, unless has_degree_at_most_one, those that the boundary may pass through or over which the
/// degree is above 1. The others cover the plane at most once. triangles: those of an orientable chart, one split of
/// each quad; loops: all of its; z (V,), finite. O(n log b) for n triangles and b boundary edges, where few boxes meet.
std::vector<int> overlap_suspects(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<BoundaryLoop>& loops, const ComplexVector& z);

}  // namespace spectral_conformal
