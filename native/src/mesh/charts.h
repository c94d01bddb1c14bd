#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/shared_vector.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A connected, consistently wound set of faces with its own vertices.
struct Chart {
  std::vector<int> faces;                         ///< in the mesh, ascending
  std::vector<int> vertices;                      ///< the mesh vertex of each chart vertex, ascending
  SharedVector<std::array<int, 3>> triangles;     ///< chart vertices, counterclockwise
  SharedVector<TriangleWeight> triangle_weights;  ///< per triangle: 1, or 1/2 for four in a row, see quad_splits
  std::vector<int> triangle_face;                 ///< per triangle: index into `faces`
  std::vector<BoundaryLoop> boundary_loops;       ///< chart vertices; unordered
  int euler_characteristic = 0;
  bool orientable = true;
  int self_intersecting_polygons = 0;  ///< n-gons whose projection has no simple triangulation
  int reversed_faces = 0;              ///< faces reoriented to agree with the majority
  std::vector<int> duplicates;         ///< faces omitted because one of `faces` has the same vertices

  int n_vertices() const { return static_cast<int>(vertices.size()); }
  /// For an orientable chart: (2 - loops - Euler characteristic) / 2.
  int genus() const { return (2 - static_cast<int>(boundary_loops.size()) - euler_characteristic) / 2; }
  /// (V, 3) positions of the chart's own vertices.
  Positions positions(const PolygonMesh& mesh) const;
};

struct ChartDecomposition {
  std::vector<Chart> charts;                ///< in the order of their first face
  std::vector<int> chart_of_face;           ///< (n_faces,), -1 for a face in no chart
  std::vector<int> chart_vertex_of_corner;  ///< (n_corners,), index into the chart's vertices, -1 outside charts
  std::vector<int> degenerate_faces;        ///< selected, with fewer than three distinct vertices or one twice in a row
  int non_manifold_edges = 0;               ///< edges of three or more selected faces, where charts are split
  int split_vertices = 0;                   ///< mesh vertices with several copies within one chart
};

/// Cuts a polygon mesh into charts, connected over edges of exactly two selected faces that are not seams. A vertex
/// gets one copy per fan, which splits seams, edges with three or more faces and bow-tie vertices. Faces wound against
/// the majority of their chart are reoriented. Of several faces on the same vertices one is kept; the others take the
/// vertices of its corners. Polygons are triangulated by triangulate_polygon. Linear in the number of corners. Throws
/// InvalidMesh as validate does.
ChartDecomposition build_charts(const PolygonMesh& mesh);

}  // namespace spectral_conformal
