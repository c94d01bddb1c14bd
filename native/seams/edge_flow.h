#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal {

class SeamGraph;

/// How edge loops run over a mesh. A vertex inside is regular if its faces are four quads; there an edge goes straight
/// on to the opposite one. Two triangles in about one plane count as a quad if its corners are about right angles; each
/// triangle belongs to one quad at most, the most rectangular ones first.
struct EdgeFlow {
  /// graph: of `mesh`, with its edges, faces and vertices.
  static EdgeFlow of(const PolygonMesh& mesh, const SeamGraph& graph);

  std::vector<int> quad;  ///< (faces,) the quad that each belongs to, numbered by its first face, or -1
  /// (edges,) per edge and end, in the order of SeamGraph::Edge::vertices: the edge that goes straight on, or -1.
  std::vector<std::array<int, 2>> onward;
};

/// The closed curves of edges that go straight on at every vertex and pass each once, without cut edges. Loops that run
/// beside each other, with a band of quads between every two, are a family.
struct EdgeLoops {
  static EdgeLoops of(const SeamGraph& graph);

  std::vector<std::vector<int>> loops;  ///< edges in order
  std::vector<int> loop_of;             ///< (edges,) the loop of each, -1 for none
  std::vector<int> family;              ///< (loops,) equal for those of a family
};

}  // namespace spectral_conformal
