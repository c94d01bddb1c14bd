#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/shared_vector.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A disk-like chart, centered and scaled to extent 1, so that results do not depend on the coordinates' origin and
/// unit; its holes filled if requested.
struct NormalizedPatch {
  Positions positions;  ///< of the chart's vertices, then of vertices added in filled holes
  int n_vertices = 0;   ///< of the chart
  double scale = 1;     ///< input units per unit of `positions`
  BoundaryLoop outer;   ///< the longest loop in 3D
  std::vector<BoundaryLoop> inner;
  SharedVector<std::array<int, 3>> triangles;     ///< counterclockwise; the chart's, then those in filled holes
  SharedVector<TriangleWeight> triangle_weights;  ///< per triangle, see Chart
  std::size_t n_virtual = 0;                      ///< triangles in filled holes

  auto surface() const { return positions.topRows(n_vertices); }  ///< positions of the chart's vertices
};

/// positions: (V, 3), of the chart's vertices. Throws InvalidMesh if why_not_parameterizable gives a reason.
NormalizedPatch normalized_patch(const Chart& chart, const Eigen::Ref<const Positions>& positions, bool fill_holes);

/// Extends the map z (chart vertices,) to the vertices added in filled holes, each at the mean of its neighbors.
ComplexVector with_virtual_vertices(const NormalizedPatch& patch, const ComplexVector& z);

/// Distortion of a map (chart vertices,) in 3D, without virtual triangles.
Distortion chart_distortion(const NormalizedPatch& patch, const ComplexVector& z);

/// The number of its flipped triangles, those of both splits of quads.
int n_flipped(const NormalizedPatch& patch, const ComplexVector& z);
/// The same, of one split of each quad (Distortion::triangulation): convex in the map or not, it need not be flipped.
int n_flipped_of_triangulation(const NormalizedPatch& patch, const ComplexVector& z);

/// Whether the border allows a map (chart vertices,) without clockwise triangles to overlap itself (map_degree.h).
bool may_cover_itself(const NormalizedPatch& patch, const ComplexVector& z);

/// How many triangles of a positively oriented map (chart vertices,) overlap others; searched for only if the border
/// allows overlaps.
int n_covering_triangles(const NormalizedPatch& patch, const ComplexVector& z);

}  // namespace spectral_conformal
