#pragma once

#include <array>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Triangles that cover every face of a chart once.
struct MapTriangulation {
  std::vector<std::array<int, 3>> triangles;  ///< chart vertices, counter-clockwise in 3D
  std::vector<int> face;                      ///< per triangle: index into the chart's faces, ascending
};

/// One triangulation of a chart for questions about its map z (V,): the chart's own, but of the two splits of a quad
/// the one that does not fold in the map if there is one (the one whose smaller signed area is larger, of equals the
/// first).
MapTriangulation triangulate_map(const Chart& chart, const ComplexVector& z);

}  // namespace spectral_conformal
