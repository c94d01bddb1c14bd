#include "mesh/mirror_symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <utility>

namespace spectral_conformal {
namespace {

bool selected(const PolygonMesh& mesh, int face) { return mesh.selected_faces == nullptr || mesh.selected_faces[face]; }

/// Finds the vertices within a radius of a point, in a grid of cells of twice that radius.
class NearbyVertices {
 public:
  NearbyVertices(const Positions& points, const std::vector<int>& used, double radius)
      : points_(points), radius_(radius), cell_(2 * radius) {
    for (const int v : used) cells_[key(cell_of(points.row(v)))].push_back(v);
  }
  /// Those within the radius, ascending.
  std::vector<int> near(const Eigen::RowVector3d& point) const {
    std::vector<int> result;
    const auto centre = cell_of(point);
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const auto found = cells_.find(
          key({centre[0] + neighbour % 3 - 1, centre[1] + neighbour / 3 % 3 - 1, centre[2] + neighbour / 9 - 1}));
      if (found == cells_.end()) continue;
      for (const int v : found->second) {
        if ((points_.row(v) - point).norm() <= radius_) result.push_back(v);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Eigen::RowVector3d& p) const {
    return {static_cast<std::int64_t>(std::floor(p[0] / cell_)), static_cast<std::int64_t>(std::floor(p[1] / cell_)),
            static_cast<std::int64_t>(std::floor(p[2] / cell_))};
  }
  /// Cells of the same key are told apart by the distances.
  static std::uint64_t key(const Cell& cell) {
    return static_cast<std::uint64_t>(cell[0]) * 73856093U ^ static_cast<std::uint64_t>(cell[1]) * 19349663U ^
           static_cast<std::uint64_t>(cell[2]) * 83492791U;
  }

  const Positions& points_;
  double radius_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

/// Vertices of selected faces with finite coordinates.
std::vector<int> used_vertices(const PolygonMesh& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.n_vertices), 0);
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!selected(mesh, face)) continue;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) used[mesh.corner_vertices[c]] = 1;
  }
  std::vector<int> result;
  for (int v = 0; v < mesh.n_vertices; ++v) {
    const double* p = mesh.positions + 3 * static_cast<std::size_t>(v);
    if (used[v] != 0 && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) result.push_back(v);
  }
  return result;
}

/// Faces by their sorted vertices.
class FaceTable {
 public:
  explicit FaceTable(const PolygonMesh& mesh) : mesh_(mesh) {
    for (int face = 0; face < mesh.n_faces; ++face) {
      if (selected(mesh, face)) faces_.emplace_back(vertices(face), face);
    }
    std::sort(faces_.begin(), faces_.end());
  }
  const std::vector<std::pair<std::vector<int>, int>>& faces() const { return faces_; }
  /// The face on these sorted vertices, the first of several, or -1.
  int find(const std::vector<int>& sorted) const {
    const auto place = std::lower_bound(faces_.begin(), faces_.end(), std::make_pair(sorted, -1));
    return place != faces_.end() && place->first == sorted ? place->second : -1;
  }

 private:
  std::vector<int> vertices(int face) const {
    std::vector<int> sorted(mesh_.corner_vertices + mesh_.face_offsets[face],
                            mesh_.corner_vertices + mesh_.face_offsets[face + 1]);
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }
  const PolygonMesh& mesh_;
  std::vector<std::pair<std::vector<int>, int>> faces_;
};

/// The other vertices of the selected faces at a vertex.
std::vector<std::vector<int>> face_mates(const PolygonMesh& mesh) {
  std::vector<std::vector<int>> mates(static_cast<std::size_t>(mesh.n_vertices));
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!selected(mesh, face)) continue;
    const int* first = mesh.corner_vertices + mesh.face_offsets[face];
    const int* last = mesh.corner_vertices + mesh.face_offsets[face + 1];
    for (const int* v = first; v != last; ++v) {
      std::copy_if(first, last, std::back_inserter(mates[*v]), [&](int other) { return other != *v; });
    }
  }
  for (auto& list : mates) std::sort(list.begin(), list.end());
  return mates;
}

/// Matches the vertices across one plane. Of several in the same place the one counts whose faces have most vertices
/// that are images of its own faces' vertices. Only pairs that name each other are kept.
void match_vertices(const Positions& points, const std::vector<int>& used, const NearbyVertices& nearby,
                    const std::vector<std::vector<int>>& mates, MirrorSymmetry& result) {
  std::vector<int> image(static_cast<std::size_t>(points.rows()), -1);
  std::vector<std::pair<int, std::vector<int>>> ambiguous;
  for (const int v : used) {
    Eigen::RowVector3d mirrored = points.row(v);
    mirrored[result.axis] = -mirrored[result.axis];
    std::vector<int> near = nearby.near(mirrored);
    if (near.size() == 1) image[v] = near.front();
    if (near.size() > 1) ambiguous.emplace_back(v, std::move(near));
  }
  std::vector<int> chosen;
  for (const auto& [v, candidates] : ambiguous) {
    const auto common = [&, own = v](int candidate) {
      return std::count_if(mates[own].begin(), mates[own].end(), [&](int mate) {
        return image[mate] >= 0 && std::binary_search(mates[candidate].begin(), mates[candidate].end(), image[mate]);
      });
    };
    chosen.push_back(
        *std::max_element(candidates.begin(), candidates.end(), [&](int a, int b) { return common(a) < common(b); }));
  }
  for (std::size_t i = 0; i < chosen.size(); ++i) image[ambiguous[i].first] = chosen[i];
  result.vertex.assign(image.size(), -1);
  result.side.assign(image.size(), 0);
  for (const int v : used) {
    if (image[v] >= 0 && image[image[v]] == v) result.vertex[v] = image[v];
    if (result.vertex[v] != v) result.side[v] = points(v, result.axis) < 0 ? -1 : 1;
  }
}

int match_faces(const FaceTable& table, MirrorSymmetry& result) {
  int matched = 0;
  std::vector<int> mirrored;
  for (const auto& [vertices, face] : table.faces()) {
    mirrored.clear();
    for (const int v : vertices) mirrored.push_back(result.vertex[v]);
    std::sort(mirrored.begin(), mirrored.end());
    if (mirrored.empty() || mirrored.front() < 0) continue;
    result.face[face] = table.find(mirrored);
    matched += result.face[face] >= 0 ? 1 : 0;
  }
  return matched;
}

}  // namespace

MirrorSymmetry find_mirror_symmetry(const PolygonMesh& mesh, double tolerance) {
  validate(mesh);
  const auto no_image = [&](std::size_t n) { return std::vector<int>(n, -1); };
  MirrorSymmetry best{-1, no_image(static_cast<std::size_t>(mesh.n_vertices)),
                      no_image(static_cast<std::size_t>(mesh.n_faces)),
                      std::vector<signed char>(static_cast<std::size_t>(mesh.n_vertices), 0)};
  const std::vector<int> used = used_vertices(mesh);
  if (used.empty()) return best;
  const Eigen::Map<const Positions> given(mesh.positions, mesh.n_vertices, 3);
  Eigen::RowVector3d low = given.row(used.front());
  Eigen::RowVector3d high = low;
  for (const int v : used) {
    low = low.cwiseMin(given.row(v));
    high = high.cwiseMax(given.row(v));
  }
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0) || !std::isfinite(extent)) return best;
  // In units of the extent, from the centre, the cells of the grid have small numbers.
  Positions points = Positions::Zero(mesh.n_vertices, 3);
  for (const int v : used) points.row(v) = (given.row(v) - (low + 0.5 * (high - low))) / extent;
  const NearbyVertices nearby(points, used, tolerance * (high - low).norm() / extent);
  const std::vector<std::vector<int>> mates = face_mates(mesh);
  const FaceTable table(mesh);
  int most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    MirrorSymmetry candidate{axis, {}, no_image(static_cast<std::size_t>(mesh.n_faces)), {}};
    match_vertices(points, used, nearby, mates, candidate);
    const int matched = match_faces(table, candidate);
    if (matched <= most) continue;
    most = matched;
    best = std::move(candidate);
  }
  return best;
}

}  // namespace spectral_conformal
