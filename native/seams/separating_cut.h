#pragma once

#include <cstddef>
#include <vector>

#include "graph/adjacency.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The faces of the cut search, a chart of the graph's mesh, and their dual graph. The functions below number them by
/// their index in `faces`.
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

/// The distance of every face from the nearest source, along the centers of neighboring faces; infinite without a path.
std::vector<double> face_distances(const SeparableFaces& faces, const std::vector<int>& sources);

/// The connected parts of some of the faces, largest area first.
std::vector<std::vector<int>> connected_parts(const SeparableFaces& faces, const std::vector<int>& some);

/// The source side of a short cut that separates two sets of faces, such as a neck between them: per face, 1 on that
/// side. Among the level sets of (distance from the sources - distance from the sinks), it takes the one with the
/// lowest cost relative to the square root of the smaller side's area, and then moves it to the cheapest cut nearby
/// (minimum cut of the dual graph). All 0 if no level leaves `min_fraction` of the area on both sides.
std::vector<char> separating_side(const SeparableFaces& faces, const std::vector<int>& sources,
                                  const std::vector<int>& sinks, double min_fraction);

}  // namespace spectral_conformal
