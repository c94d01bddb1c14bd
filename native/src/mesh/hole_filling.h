#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Virtual triangles that close the inner boundary loops of a chart. They stiffen the holes and enter no measure.
struct HoleFilling {
  Positions centers;                             ///< (n, 3) positions of added vertices, numbered from V on
  std::vector<std::array<int, 3>> triangles;     ///< counterclockwise, like those of the chart
  std::vector<TriangleWeight> triangle_weights;  ///< per triangle
};

/// Fills every loop but `outer`. A loop that is star-shaped about its barycenter, as seen along its vector area, gets a
/// fan around it, so that a symmetric hole is filled symmetrically; loops of three and four vertices, and all others,
/// are triangulated like polygons (triangulate_polygon). loops: as in Chart; positions (V, 3), finite.
HoleFilling fill_holes(const std::vector<BoundaryLoop>& loops, int outer, const Eigen::Ref<const Positions>& positions);

}  // namespace spectral_conformal
