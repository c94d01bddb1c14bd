#include "seams/canonical_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "concurrency/listening.h"
#include "concurrency/work_counter.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// Each round looks one edge further. Only regions that lie in one point need many, and these get no seams.
constexpr int max_rounds = 32;

/// The corners of the selected faces, grouped by vertex.
class SelectedFaces {
 public:
  explicit SelectedFaces(const PolygonMesh& mesh)
      : mesh_(mesh), corners_(mesh.n_vertices, [&](const auto& visit) { each_corner(visit); }) {}

  bool uses(int vertex) const { return !corners_[vertex].empty(); }
  /// Distinguishes vertices of equal rank: for each face at the vertex, its number of corners and the ranks of the next
  /// and the previous vertex; sorted.
  std::vector<std::array<int, 3>> signature(int vertex, const std::vector<int>& rank) const {
    std::vector<std::array<int, 3>> result;
    for (const auto& [face, corner] : corners_[vertex]) {
      const int first = mesh_.face_offsets[face];
      const int last = mesh_.face_offsets[face + 1] - 1;
      const int next = mesh_.corner_vertices[corner == last ? first : corner + 1];
      const int previous = mesh_.corner_vertices[corner == first ? last : corner - 1];
      result.push_back({mesh_.n_corners(face), rank[next], rank[previous]});
    }
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  struct FaceCorner {
    int face;
    int corner;
  };

  template <class Visit>
  void each_corner(const Visit& visit) const {
    for (int face = 0; face < mesh_.n_faces; ++face) {
      if (!mesh_.is_selected(face)) continue;
      still_working(10.0 * mesh_.n_corners(face));
      for (int c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
        visit(mesh_.corner_vertices[c], FaceCorner{face, c});
      }
    }
  }

  const PolygonMesh& mesh_;
  Grouped<FaceCorner> corners_;
};

/// Lexicographic order of coordinates, NaN last. 0 and -0 are equal.
bool lies_before(const double* a, const double* b) {
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(a[k]) != std::isnan(b[k])) return std::isnan(b[k]);
    if (a[k] < b[k]) return true;
    if (a[k] > b[k]) return false;
  }
  return false;
}

/// Sorts the vertices of each rank by signature and ranks them anew. Returns whether this split any rank.
bool refine(const SelectedFaces& faces, std::vector<int>& order, std::vector<int>& rank) {
  bool split = false;
  const std::vector<int> before = rank;
  std::vector<std::pair<std::vector<std::array<int, 3>>, int>> members;
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && before[order[last]] == before[order[first]]) ++last;
    if (last == first + 1) continue;
    members.clear();
    for (std::size_t i = first; i < last; ++i) {
      members.emplace_back(faces.signature(order[i], before), order[i]);
      still_working(100.0 * static_cast<double>(members.back().first.size()));
    }
    std::sort(members.begin(), members.end());
    for (std::size_t i = first; i < last; ++i) {
      order[i] = members[i - first].second;
      const bool is_new = i > first && members[i - first].first != members[i - first - 1].first;
      rank[order[i]] = is_new ? static_cast<int>(i) : i > first ? rank[order[i - 1]] : static_cast<int>(first);
      split = split || is_new;
    }
  }
  return split;
}

/// Rotates the corners of a face to the lexicographically least sequence, which starts at its first vertex. Compares
/// two starts at a time; the loser also rules out the starts in its matched part, so the time is linear.
void turn_to_first_vertex(std::vector<int>& corners) {
  const std::size_t n = corners.size();
  std::size_t least = 0;
  std::size_t other = 1;
  std::size_t same = 0;
  const auto at = [&](std::size_t begin) { return corners[begin + same < n ? begin + same : begin + same - n]; };
  while (other < n && least < n && same < n) {
    count_steps(1);
    if (at(least) == at(other)) {
      ++same;
      continue;
    }
    (at(least) > at(other) ? least : other) += same + 1;
    if (least == other) ++other;
    same = 0;
  }
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(std::min(least, other)), corners.end());
}

/// The used vertices in canonical order.
std::vector<int> canonical_order(const PolygonMesh& mesh) {
  const SelectedFaces faces(mesh);
  std::vector<int> order;
  for (int v = 0; v < mesh.n_vertices; ++v) {
    if (faces.uses(v)) order.push_back(v);
  }
  const auto position = [&](int v) { return mesh.positions + 3 * static_cast<std::size_t>(v); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return lies_before(position(a), position(b)); });
  std::vector<int> rank(static_cast<std::size_t>(mesh.n_vertices), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || lies_before(position(order[i - 1]), position(order[i]));
    rank[order[i]] = is_new ? static_cast<int>(i) : rank[order[i - 1]];
  }
  for (int round = 0; round < max_rounds && refine(faces, order, rank); ++round) continue;
  return order;
}

}  // namespace

CanonicalMesh::CanonicalMesh(const PolygonMesh& mesh) {
  validate(mesh);
  vertices_ = canonical_order(mesh);
  positions_.resize(static_cast<Eigen::Index>(vertices_.size()), 3);
  std::vector<int> number(static_cast<std::size_t>(mesh.n_vertices), -1);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    number[vertices_[i]] = static_cast<int>(i);
    for (int k = 0; k < 3; ++k) {
      positions_(static_cast<Eigen::Index>(i), k) = mesh.positions[3 * static_cast<std::size_t>(vertices_[i]) + k];
    }
  }
  std::vector<std::vector<int>> faces;
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    std::vector<int> corners;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      corners.push_back(number[mesh.corner_vertices[c]]);
    }
    turn_to_first_vertex(corners);
    still_working(50.0 * static_cast<double>(corners.size()));
    faces.push_back(std::move(corners));
  }
  std::sort(faces.begin(), faces.end());
  for (const auto& corners : faces) {
    corner_vertices_.insert(corner_vertices_.end(), corners.begin(), corners.end());
    face_offsets_.push_back(static_cast<int>(corner_vertices_.size()));
  }
  for (int i = 0; i < mesh.n_seam_edges; ++i) {
    const int a = number[mesh.seam_edges[i][0]];
    const int b = number[mesh.seam_edges[i][1]];
    if (a >= 0 && b >= 0) seams_.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(seams_.begin(), seams_.end());
  seams_.erase(std::unique(seams_.begin(), seams_.end()), seams_.end());
}

PolygonMesh CanonicalMesh::view() const {
  PolygonMesh mesh;
  mesh.positions = positions_.data();
  mesh.n_vertices = static_cast<int>(vertices_.size());
  mesh.face_offsets = face_offsets_.data();
  mesh.n_faces = static_cast<int>(face_offsets_.size()) - 1;
  mesh.corner_vertices = corner_vertices_.data();
  mesh.seam_edges = seams_.data();
  mesh.n_seam_edges = static_cast<int>(seams_.size());
  return mesh;
}

}  // namespace spectral_conformal
