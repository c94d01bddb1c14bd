#pragma once

#include <map>
#include <vector>

#include "mesh/charts.h"
#include "mesh/owned_mesh.h"

namespace spectral_conformal {

/// A mesh whose vertices are split where their pins differ, as Blender does: each selected corner of a split vertex
/// goes to the copy whose pin is nearest to its UV; the first pin keeps the vertex. Seams run along all copies of an
/// edge.
class PinSplitMesh {
 public:
  /// The arrays of `mesh` must outlive this object. Throws InvalidMesh for arrays that do not describe a mesh, and if
  /// the copies exceed the size limit.
  static PinSplitMesh of(const PolygonMesh& mesh, const CornerPins& pins);

  PolygonMesh view() const { return copied_.empty() ? mesh_ : split_.view_on(mesh_); }
  /// The mesh vertex of which vertex v of the view is a copy (or v itself).
  int original_vertex(int v) const {
    return v < mesh_.n_vertices ? v : copied_[static_cast<std::size_t>(v - mesh_.n_vertices)];
  }

 private:
  /// `split`: the distinct pins of the split vertices.
  void add_seams(const std::map<int, std::vector<Complex>>& split);

  PolygonMesh mesh_;
  std::vector<int> copied_;
  OwnedMesh split_;  ///< without faces; empty if nothing was split
};

/// The pins of a chart: the mean over the pinned corners of each of its vertices. `mesh` is a PinSplitMesh's view,
/// `chart_vertex_of_corner` that of its ChartDecomposition. Throws InvalidMesh if a pinned UV is not finite.
Pins chart_pins(const PolygonMesh& mesh, const Chart& chart, const std::vector<int>& chart_vertex_of_corner,
                const CornerPins& pins);

}  // namespace spectral_conformal
