#pragma once

#include <array>
#include <vector>

#include "mesh/charts.h"
#include "mesh/half_edges.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// The number of independent closed curves that do not separate a chart, twice the genus: 0 only for a sphere, and for
/// a disk with or without holes. For a non-orientable chart it is an upper bound, above 0.
int handle_curves(const Chart& chart);

/// A connected polygonal surface that is cut open edge by edge. Each cut updates the Euler characteristic and the
/// number of boundary loops: it walks around its vertices and along the boundary that it meets. A search from both
/// sides of the cut shows whether the surface is still connected. Distant parts are not visited, except on a
/// non-orientable surface, which any cut may make orientable.
class CutSurface {
 public:
  /// `chart`: the only one of `mesh`. `graph`: of `mesh`. The arrays of `mesh` must outlive this object.
  CutSurface(const PolygonMesh& mesh, const SeamGraph& graph, const Chart& chart);

  /// handle_curves(Chart) of the surface as build_charts would cut it.
  int handle_curves() const { return handle_curves(orientable_, loops_); }
  /// Cuts along edges of the graph if the surface stays connected and loses handle curves. With `may_join`, it may also
  /// keep their number if boundary loops merge: later cuts along paths between these then open handles. Returns whether
  /// it cut; otherwise nothing changes.
  bool try_cut(const std::vector<int>& edges, bool may_join = false);

 private:
  /// A corner of a face and one of its two half-edges, across which a walk around the corner's vertex continues.
  struct Spoke {
    int corner;
    int half_edge;
  };

  int handle_curves(bool orientable, int loops) const { return 2 - (orientable ? loops : 0) - euler_characteristic_; }
  int previous(int corner) const;
  /// The other half-edge at the corner.
  Spoke turned(const Spoke& spoke) const;
  /// The open half-edge at which the fan of faces around a vertex ends.
  Spoke fan_end(Spoke spoke) const;
  /// The next half-edge along the boundary, and the corner at which the walk enters it.
  Spoke next_on_boundary(const Spoke& spoke) const;
  int count_loops() const;
  void cut(int edge);
  bool is_connected_across(const std::vector<int>& edges);
  bool is_orientable() const;

  PolygonMesh mesh_;
  HalfEdges half_edges_;
  std::vector<int> twin_;                   ///< per half-edge: its twin in half_edges_, -1 once it is cut
  std::vector<std::array<int, 2>> halves_;  ///< per edge of the graph: its two half-edges, -1 if they are not twins
  std::vector<int> side_of_face_;           ///< scratch of is_connected_across, -1 between calls
  int euler_characteristic_;
  int loops_;
  bool orientable_;
};

}  // namespace spectral_conformal
