#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/shared_vector.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A disk-like chart, centered and scaled to extent 1, so that any coordinates give the same numbers; its holes filled
/// where that was asked for.
struct NormalizedPatch {
  Positions positions;  ///< of the chart's vertices, then of those added in filled holes
  int n_vertices = 0;   ///< of the chart
  double scale = 1;     ///< input units per unit of `positions`
  BoundaryLoop outer;   ///< the longest in 3D
  std::vector<BoundaryLoop> inner;
  SharedVector<std::array<int, 3>> triangles;     ///< counter-clockwise; the chart's, then those in filled holes
  SharedVector<TriangleWeight> triangle_weights;  ///< per triangle, see Chart
  std::size_t n_virtual = 0;                      ///< triangles in filled holes

  auto surface() const { return positions.topRows(n_vertices); }  ///< positions of the chart's vertices
};

/// positions (V, 3) of the chart's vertices. Throws InvalidMesh when why_not_parameterizable says so.
NormalizedPatch normalized_patch(const Chart& chart, const Eigen::Ref<const Positions>& positions, bool fill_holes);

/// The map z (chart vertices,) with the vertices added in filled holes, each at the mean of its neighbors.
ComplexVector with_virtual_vertices(const NormalizedPatch& patch, const ComplexVector& z);

/// Distortion of a map (chart vertices,) in 3D, without virtual triangles.
Distortion chart_distortion(const NormalizedPatch& patch, const ComplexVector& z);

/// Whether the border lets parts of a map (chart vertices,) without clockwise triangles lie on each other
/// (map_degree.h).
bool may_cover_itself(const NormalizedPatch& patch, const ComplexVector& z);

/// How many triangles of a map (chart vertices,), positively oriented, lie on others: found only where the border
/// leaves that possible.
int n_covering_triangles(const NormalizedPatch& patch, const ComplexVector& z);

}  // namespace spectral_conformal
