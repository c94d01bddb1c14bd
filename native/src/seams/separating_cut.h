#pragma once

#include <vector>

#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The faces among which a cut is looked for: a chart of the graph's mesh.
struct SeparableFaces {
  const SeamGraph* graph = nullptr;
  std::vector<char> member;             ///< per face of the mesh: whether it belongs to the chart
  std::vector<double> area;             ///< per face of the mesh
  std::vector<Eigen::Vector3d> centre;  ///< per face of the mesh
};

/// Distance of every face from the nearest source over the centres of neighbouring faces; infinite where there is no
/// path.
std::vector<double> face_distances(const SeparableFaces& faces, const std::vector<int>& sources);

/// The connected parts of some of the faces, the one with the largest area first.
std::vector<std::vector<int>> connected_parts(const SeparableFaces& faces, const std::vector<int>& some);

/// The source's side of a short cut that parts two sets of faces, such as a neck between them: per face of the mesh, 1
/// on that side. Of the level sets of (distance from the sources - distance from the sinks) the one with the lowest
/// cost relative to the root of the smaller side's area is taken, and then moved to the cheapest cut nearby (minimum
/// cut of the dual graph). All 0 where no level leaves `min_fraction` of the area on both sides.
std::vector<char> separating_side(const SeparableFaces& faces, const std::vector<int>& sources,
                                  const std::vector<int>& sinks, double min_fraction);

}  // namespace spectral_conformal
