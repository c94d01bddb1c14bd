#include "spectral_conformal/map_defects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "graph/grouped.h"
#include "mesh/charts.h"
#include "mesh/owned_mesh.h"
#include "quality/flips.h"
#include "quality/overlap.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// The mesh in the plane of its map: its vertices are the distinct images of mesh vertices.
class MapMesh {
 public:
  static MapMesh of(const PolygonMesh& mesh, const double* corner_uv) {
    MapMesh result(mesh);
    Grouped<Image> images(mesh.n_vertices, [&](const auto& visit) {
      for_each_polled(mesh.n_faces, [&](int face) {
        if (!mesh.is_selected(face)) return;
        for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
          const double* uv = corner_uv + 2 * static_cast<std::size_t>(c);
          if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
            throw InvalidMesh(Rejection::uv_not_finite, c, face);
          }
          visit(mesh.corner_vertices[c], Image{uv[0], uv[1], c});
        }
      });
    });
    // Unselected corners refer to a vertex too.
    result.own_.corner_vertices.assign(static_cast<std::size_t>(mesh.n_corners()), 0);
    int n_points = 0;
    for_each_polled(mesh.n_vertices, [&](int v) {
      const auto [first, last] = images[v];
      std::sort(first, last);
      for (const Image* image = first; image != last; ++image) {
        if (image == first || !(image - 1)->same_point(*image)) ++n_points;
        result.own_.corner_vertices[image->corner] = n_points - 1;
      }
    });
    result.own_.positions = Positions::Zero(std::max(n_points, 1), 3);
    for_each_selected_corner(mesh, [&](int c, int /*face*/) {
      const double* uv = corner_uv + 2 * static_cast<std::size_t>(c);
      result.own_.positions.row(result.own_.corner_vertices[c]) << uv[0], uv[1], 0;
    });
    poll(mesh.n_corners());
    return result;
  }

  PolygonMesh view() const { return own_.view_on(mesh_); }

 private:
  explicit MapMesh(const PolygonMesh& mesh) : mesh_(mesh) {}

  /// An image of one mesh vertex.
  struct Image {
    double u;
    double v;
    int corner;

    bool operator<(const Image& other) const {
      if (u != other.u) return u < other.u;
      return v != other.v ? v < other.v : corner < other.corner;
    }
    bool same_point(const Image& other) const { return u == other.u && v == other.v; }
  };

  PolygonMesh mesh_;
  OwnedMesh own_;  ///< without faces
};

/// The map of an island, indexed by its own vertices.
ComplexVector map_of(const Chart& island, const PolygonMesh& mesh) {
  ComplexVector z(island.n_vertices());
  for (int v = 0; v < island.n_vertices(); ++v) {
    const double* p = mesh.position(island.vertices[static_cast<std::size_t>(v)]);
    z[v] = Complex(p[0], p[1]);
  }
  return z;
}

/// The mesh face of a triangle.
int face_of(const Chart& island, int triangle) {
  return island.faces[static_cast<std::size_t>(island.triangle_face[static_cast<std::size_t>(triangle)])];
}

/// Adds an island to a map of several. `oriented`: its map, mirrored if necessary to be positively oriented.
void add_island(const Chart& island, const ComplexVector& z, const ComplexVector& oriented, MapOfCharts& map) {
  const std::vector<int> chosen = mapped_triangulation(island.triangles, island.triangle_weights, oriented);
  std::vector<int> faces;
  faces.reserve(chosen.size());
  for (const int t : chosen) faces.push_back(face_of(island, t));
  map.add(island, z, signed_area(island.triangles, island.triangle_weights, z) < 0, chosen, faces);
}

void mark_flipped(const Chart& island, const ComplexVector& z, const FlipTolerance& tolerance,
                  std::vector<bool>& faces) {
  for (const int t : mapped_triangulation(island.triangles, island.triangle_weights, z)) {
    if (is_flipped(island.triangles[static_cast<std::size_t>(t)], z, tolerance)) faces[face_of(island, t)] = true;
  }
}

}  // namespace

MapDefects find_map_defects(const PolygonMesh& mesh, const double* corner_uv, bool between_islands) {
  validate(mesh);
  const MapMesh map_mesh = MapMesh::of(mesh, corner_uv);
  const PolygonMesh in_plane = map_mesh.view();
  MapDefects result;
  result.flipped.assign(static_cast<std::size_t>(mesh.n_faces), false);
  result.overlapping = result.flipped;
  MapOfCharts layout;
  ChartDecomposition islands = build_charts(in_plane);
  result.island_of_face = std::move(islands.chart_of_face);
  for (const Chart& island : islands.charts) {
    const ComplexVector z = map_of(island, in_plane);
    const ComplexVector oriented = positively_oriented(island.triangles, island.triangle_weights, z);
    mark_flipped(island, oriented, {0, stored_resolution}, result.flipped);
    if (between_islands) {
      add_island(island, z, oriented, layout);
    } else {
      for (const int face : overlapping_faces(island, oriented, stored_resolution)) {
        result.overlapping[island.faces[static_cast<std::size_t>(face)]] = true;
      }
    }
  }
  const std::vector<bool> overlapping = overlapping_in_map(layout, stored_resolution);
  for (std::size_t t = 0; t < overlapping.size(); ++t) {
    if (overlapping[t]) result.overlapping[layout.face[t]] = true;
  }
  return result;
}

}  // namespace spectral_conformal
