#pragma once

#include <cstddef>
#include <vector>

#include "mesh/charts.h"
#include "mesh/corner_pins.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal {

/// A mesh cut into charts.
struct MeshCut {
  PinSplitMesh split;
  PolygonMesh mesh;  ///< the view of `split`
  ChartDecomposition decomposition;
  std::vector<int> first_vertex;  ///< of each chart, if vertices are numbered chart after chart
};

/// The arrays of `given` must outlive the result. Throws InvalidMesh for arrays that do not describe a mesh.
MeshCut cut_mesh(const PolygonMesh& given, const CornerPins& corner_pins);

/// The extenders that act in a chart, on its vertices.
struct ChartExtenders {
  std::vector<Extender> extenders;
  std::vector<std::size_t> numbers;  ///< of each among the given ones, ascending
};

/// Those of each chart.
std::vector<ChartExtenders> extenders_of_charts(const MeshCut& cut, const std::vector<VertexExtender>& extenders);

/// The equations of each chart, on its vertices. constraints: on corners; an equation with corners in several charts,
/// or in none, is left out.
std::vector<LinearEquations> equations_of_charts(const MeshCut& cut, const LinearEquations& constraints);

}  // namespace spectral_conformal
