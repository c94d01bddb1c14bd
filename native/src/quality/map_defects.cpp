#include "spectral_conformal/map_defects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "mesh/charts.h"
#include "mesh/owned_mesh.h"
#include "mesh/welded_corners.h"
#include "quality/flips.h"
#include "quality/overlap.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// The mesh in the plane of its map: its vertices are the distinct images of mesh vertices. Without faces.
OwnedMesh mesh_of_map(const PolygonMesh& mesh, const double* corner_uv) {
  const auto* const uv = reinterpret_cast<const Complex*>(corner_uv);
  std::vector<int> is_left_out(static_cast<std::size_t>(mesh.n_corners()), 1);
  for_each_polled(mesh.n_faces, [&](int face) {
    if (!mesh.is_selected(face)) return;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      if (!is_finite(uv[c])) throw InvalidMesh(Rejection::uv_not_finite, c, face);
      is_left_out[c] = 0;
    }
  });
  WeldedCorners welded =
      welded_corners(mesh.corner_vertices, is_left_out.data(), uv, mesh.n_corners(), mesh.n_vertices);
  OwnedMesh result;
  result.positions = Positions::Zero(static_cast<Eigen::Index>(welded.first_corner.size()), 3);
  for_each_polled(welded.first_corner.size(), [&](std::size_t i) {
    const Complex point = uv[welded.first_corner[i]];
    result.positions.row(static_cast<Eigen::Index>(i)) << point.real(), point.imag(), 0;
  });
  result.corner_vertices = std::move(welded.point);
  return result;
}

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
  const OwnedMesh map_mesh = mesh_of_map(mesh, corner_uv);
  const PolygonMesh in_plane = map_mesh.view_on(mesh);
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
