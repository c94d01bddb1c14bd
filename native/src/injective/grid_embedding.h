#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A drawing of a disk, holes allowed, with straight edges, all vertices at points of an integer grid of 2 V by V: no
/// triangle is flipped, whatever the length of its limbs, and double precision holds it exactly. By the shift method
/// (de Fraysseix, Pach and Pollack, How to Draw a Planar Graph on a Grid, 1990) as Chrobak and Payne count it (A
/// Linear-Time Algorithm for Drawing a Planar Graph on a Grid, 1995), in time linear in V but for the sorting of each
/// vertex' neighbors. The angles are as bad as the grid is large.
///
/// triangles (F, 3): one triangulation of the chart, counter-clockwise, of the vertices below n; loops: as in Chart,
/// `outer` the index of the outer one. Each hole is closed by a vertex in its middle, a slit of two vertices by itself.
/// Returns (n,), or nothing where two vertices are joined by two edges, or the triangles are no disk.
/// Throws Cancelled.
ComplexVector grid_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                             int outer, int n, const Progress& progress = {});

}  // namespace spectral_conformal
