#include "seams/canonical_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "graph/adjacency.h"
#include "graph/mixed_bits.h"
#include "graph/numbering.h"
#include "seams/relative_grid.h"

namespace spectral_conformal {
namespace {

/// Each round looks one edge further. Only regions that lie in one point need many, and these get no seams.
constexpr int max_rounds = 32;

/// Lexicographic order of coordinates, NaN last. 0 and -0 are equal.
bool precedes(const double* a, const double* b) {
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(a[k]) != std::isnan(b[k])) return std::isnan(b[k]);
    if (a[k] < b[k]) return true;
    if (a[k] > b[k]) return false;
  }
  return false;
}

/// Rotates the corners of a face to start at its first vertex. If that vertex occurs several times, the one whose
/// successor comes first is the start.
void begin_at_first_vertex(std::vector<int>& corners) {
  const std::size_t n = corners.size();
  const auto edge = [&](std::size_t c) { return std::array<int, 2>{corners[c], corners[c + 1 < n ? c + 1 : 0]}; };
  std::size_t first = 0;
  for (std::size_t c = 1; c < n; ++c) {
    if (edge(c) < edge(first)) first = c;
  }
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
}

/// Calls visit(vertex, next, previous, number of corners) for the corners of the selected faces.
template <class Visit>
void for_each_corner(const PolygonMesh& mesh, const Visit& visit) {
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    const int n = mesh.n_corners(face);
    const int* const corners = mesh.corner_vertices + mesh.face_offsets[face];
    poll(n);
    for (int c = 0; c < n; ++c) visit(corners[c], corners[c + 1 < n ? c + 1 : 0], corners[c > 0 ? c - 1 : n - 1], n);
  }
}

/// (V, 3) the coordinates of the used vertices on a grid relative to their extent; NaN for the others.
Positions rounded_positions(const PolygonMesh& mesh, const std::vector<int>& used) {
  Positions positions = Positions::Constant(mesh.n_vertices, 3, std::numeric_limits<double>::quiet_NaN());
  for (const int v : used) positions.row(v) = Eigen::Map<const Eigen::RowVector3d>(mesh.position(v));
  return RelativeGrid::over(positions).coordinates(positions);
}

/// The used vertices in canonical order.
std::vector<int> canonical_order(const PolygonMesh& mesh) {
  std::vector<std::uint64_t> color(static_cast<std::size_t>(mesh.n_vertices), 0);
  for_each_corner(mesh, [&](int v, int, int, int) { color[v] = 1; });
  std::vector<int> order;
  for (int v = 0; v < mesh.n_vertices; ++v) {
    if (color[v] != 0) order.push_back(v);
  }
  const Positions rounded = rounded_positions(mesh, order);
  const auto lies_before = [&](int a, int b) { return precedes(rounded.row(a).data(), rounded.row(b).data()); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    if (lies_before(a, b) || lies_before(b, a)) return lies_before(a, b);
    return precedes(mesh.position(a), mesh.position(b));
  });
  std::size_t n_before = 0;
  for (int round = 0; round <= max_rounds; ++round) {
    std::vector<std::uint64_t> rank(color.size(), 0);
    std::size_t n_ranks = 0;
    for (auto first = order.begin(), last = first; first != order.end(); first = last) {
      last = std::find_if(first, order.end(), [&](int v) { return lies_before(*first, v); });
      poll(last - first);
      std::stable_sort(first, last, [&](int a, int b) { return color[a] < color[b]; });
      for (auto v = first; v != last; ++v) rank[*v] = v != first && color[*v] == color[*(v - 1)] ? n_ranks : ++n_ranks;
    }
    if (n_ranks == n_before || n_ranks == order.size()) break;
    n_before = n_ranks;
    color = rank;
    // The sum does not depend on the order of the faces.
    for_each_corner(mesh, [&](int v, int next, int previous, int n) {
      color[v] += mixed_bits(mixed_bits(mixed_bits(rank[next]) + rank[previous]) + static_cast<std::uint64_t>(n));
    });
  }
  return order;
}

}  // namespace

CanonicalMesh CanonicalMesh::of(const PolygonMesh& mesh) {
  validate(mesh);
  CanonicalMesh result;
  result.vertices = canonical_order(mesh);
  result.positions = Eigen::Map<const Positions>(mesh.positions, mesh.n_vertices, 3)(result.vertices, Eigen::all);
  const std::vector<int> number = indices_in(result.vertices, static_cast<std::size_t>(mesh.n_vertices));
  std::vector<std::vector<int>> faces;
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    std::vector<int> corners;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      corners.push_back(number[mesh.corner_vertices[c]]);
    }
    begin_at_first_vertex(corners);
    poll(corners.size());
    faces.push_back(std::move(corners));
  }
  std::sort(faces.begin(), faces.end());
  for (const auto& corners : faces) {
    result.corner_vertices.insert(result.corner_vertices.end(), corners.begin(), corners.end());
    result.end_face();
  }
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    const int a = number[mesh.seam_edges[i][0]];
    const int b = number[mesh.seam_edges[i][1]];
    if (a >= 0 && b >= 0) result.seams.push_back(edge_between(a, b));
  }
  std::sort(result.seams.begin(), result.seams.end());
  result.seams.erase(std::unique(result.seams.begin(), result.seams.end()), result.seams.end());
  return result;
}

}  // namespace spectral_conformal
