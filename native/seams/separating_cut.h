#pragma once

#include <cstddef>
#include <vector>

#include "graph/adjacency.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The faces of one chart of the graph's mesh, and their dual graph. The functions below refer to a face by its index
/// in `faces`.
struct SeparableFaces {
  /// All arrays have the same length; `faces` is ascending.
  SeparableFaces(const SeamGraph& graph, std::vector<int> faces, std::vector<double> area,
                 std::vector<Eigen::Vector3d> centers);

  std::size_t size() const { return faces.size(); }
  /// The index of a face of the mesh; -1 if it is not in the chart.
  int index(int face) const;

  std::vector<int> faces;
  std::vector<double> area;
  std::vector<Eigen::Vector3d> center;
  Adjacency dual;                ///< the faces as nodes, joined across uncut edges; arcs carry the indices of the edges
  std::vector<double> distance;  ///< per arc of `dual`: between the centers
  std::vector<double> cost;      ///< per arc of `dual`: of its edge
};

/// The distance of every face from the nearest source, along the centers of neighboring faces; infinite without a path.
std::vector<double> face_distances(const SeparableFaces& faces, const std::vector<int>& sources);

/// The connected parts of some of the faces, largest area first.
std::vector<std::vector<int>> connected_parts(const SeparableFaces& faces, const std::vector<int>& some);

/// The source side of a short cut that separates two sets of faces, such as a cut around a neck: per face, 1 on that
/// side. Among the level sets of (distance from the sources - distance from the sinks), takes the one with the lowest
/// cost over the square root of the smaller side's area, then moves it to the cheapest cut nearby (minimum cut of the
/// dual graph). All 0 if no level leaves `min_fraction` of the area on both sides.
std::vector<char> separating_side(const SeparableFaces& faces, const std::vector<int>& sources,
                                  const std::vector<int>& sinks, double min_fraction);

}  // namespace spectral_conformal
