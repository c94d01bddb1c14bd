#pragma once

#include <array>
#include <vector>

#include "graph/disjoint_sets.h"
#include "mesh/charts.h"
#include "mesh/half_edges.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The number of independent closed curves that do not separate a chart, twice the genus: 0 only for a sphere, and for
/// a disk with or without holes. For a non-orientable chart it is an upper bound, above 0.
int handle_curves(const Chart& chart);

/// A connected polygonal surface that is cut open along edges. Each cut counts what is left of it anew, without memory.
class CutSurface {
 public:
  /// `graph`: of `mesh`, which has only one chart. The arrays of `mesh` must outlive this object.
  static CutSurface of(const PolygonMesh& mesh, const SeamGraph& graph);

  /// handle_curves(Chart) of the surface as build_charts would cut it.
  int handle_curves() const { return topology_.handle_curves; }
  /// Cuts along edges of the graph if the surface stays connected and loses handle curves. With `may_join`, it may also
  /// keep their number if boundary loops merge: later cuts along paths between these then open handles. Returns whether
  /// it cut; otherwise nothing changes.
  bool try_cut(const std::vector<int>& edges, bool may_join = false);

 private:
  struct Topology {
    bool connected;
    int loops;
    int handle_curves;
  };
  Topology measured();

  HalfEdges half_edges_;
  std::vector<int> twin_;                   ///< per half-edge: its twin in half_edges_, -1 once it is cut
  std::vector<std::array<int, 2>> halves_;  ///< per edge of the graph: its two half-edges, -1 if they are not twins
  DisjointSets fans_{0};                    ///< the corners around each vertex
  DisjointSets sides_{0};                   ///< of the faces, two of each
  Topology topology_{};
};

}  // namespace spectral_conformal
