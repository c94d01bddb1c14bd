#pragma once

#include <array>
#include <vector>

#include "graph/adjacency.h"

namespace spectral_conformal {

/// A local minimum of a function on the vertices of a mesh.
struct FieldMinimum {
  int vertex;
  double prominence;  ///< least rise of the function on a path to a lower minimum
  double volume;      ///< of its basin below that level: the area-weighted sum of (level - value)
};

/// The local minima with at least `prominence`, by persistence of the sublevel sets, largest volume first. The basin of
/// the lowest minimum ends at `top`; values from there on belong to none. field, area: (V,), finite. neighbors: see
/// neighbors_along.
std::vector<FieldMinimum> prominent_minima(const std::vector<double>& field, const std::vector<double>& area,
                                           const Adjacency& neighbors, double top, double prominence);

/// The vertices as nodes, joined by the edges of the triangles, with repetitions. The arcs have no edge numbers.
Adjacency neighbors_along(const std::vector<std::array<int, 3>>& triangles, int n_vertices);

}  // namespace spectral_conformal
