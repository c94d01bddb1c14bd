#pragma once

#include <cstddef>
#include <vector>

#include "graph/adjacency.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The faces among which a cut is looked for, a chart of the graph's mesh, and their dual graph. What is below numbers
/// them by their index in `faces`.
struct SeparableFaces {
  /// All arrays of the same length; the faces ascending. The graph must outlive this object and not change.
  SeparableFaces(const SeamGraph& graph, std::vector<int> faces, std::vector<double> area,
                 std::vector<Eigen::Vector3d> centre);

  std::size_t size() const { return faces.size(); }
  /// The index of a face of the mesh; -1 where it is not one of these.
  int index(int face) const;

  const SeamGraph* graph;
  std::vector<int> faces;
  std::vector<double> area;
  std::vector<Eigen::Vector3d> centre;
  Adjacency dual;  ///< the faces as nodes, joined over the edges that are not cut, with the numbers of these
};

/// Distance of every face from the nearest source over the centers of neighboring faces; infinite where there is no
/// path.
std::vector<double> face_distances(const SeparableFaces& faces, const std::vector<int>& sources);

/// The connected parts of some of the faces, the one with the largest area first.
std::vector<std::vector<int>> connected_parts(const SeparableFaces& faces, const std::vector<int>& some);

/// The source's side of a short cut that parts two sets of faces, such as a neck between them: per face, 1 on that
/// side. Of the level sets of (distance from the sources - distance from the sinks) the one with the lowest cost
/// relative to the root of the smaller side's area is taken, and then moved to the cheapest cut nearby (minimum cut of
/// the dual graph). All 0 where no level leaves `min_fraction` of the area on both sides.
std::vector<char> separating_side(const SeparableFaces& faces, const std::vector<int>& sources,
                                  const std::vector<int>& sinks, double min_fraction);

}  // namespace spectral_conformal
