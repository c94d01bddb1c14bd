#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A straight-line drawing of a disk, holes allowed, with vertices on an integer grid of 2 V by V: no triangle is
/// flipped, however long its limbs, and double precision represents it exactly. It uses the shift method (de Fraysseix,
/// Pach and Pollack, How to Draw a Planar Graph on a Grid, 1990) in the form of Chrobak and Payne (A Linear-Time
/// Algorithm for Drawing a Planar Graph on a Grid, 1995), in time linear in V except for sorting the neighbors of each
/// vertex. The larger the grid, the worse the angles.
///
/// triangles (F, 3): one triangulation of the chart, counterclockwise, of the vertices below n; loops: as in Chart,
/// with `outer` the index of the outer one. Each hole is closed by a vertex in its middle; a slit of two vertices
/// closes itself. Returns (n,), or an empty vector if two edges join the same vertices or the triangles do not form a
/// disk. Throws Cancelled.
ComplexVector grid_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                             int outer, int n, const Progress& progress = {});

}  // namespace spectral_conformal
