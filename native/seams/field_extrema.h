#pragma once

#include <array>
#include <vector>

namespace spectral_conformal {

/// A local minimum of a function on the vertices of a mesh.
struct FieldMinimum {
  int vertex;
  double prominence;  ///< how far the function has to rise on every path to a lower minimum
  double volume;      ///< of its basin below that level: the area-weighted sum of (level - value)
};

/// The local minima with at least `prominence`, by the persistence of the sublevel sets, in decreasing order of volume.
/// The lowest minimum has the level `top`. field, area: (V,), finite; triangles connect the vertices. Values above
/// `top` belong to no basin.
std::vector<FieldMinimum> prominent_minima(const std::vector<double>& field, const std::vector<double>& area,
                                           const std::vector<std::array<int, 3>>& triangles, double top,
                                           double prominence);

}  // namespace spectral_conformal
