#include "mesh/half_edges.h"

#include <algorithm>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "mesh/edge_table.h"

namespace spectral_conformal {
namespace {

/// Fewer than three distinct vertices, or a vertex twice in a row.
bool is_degenerate(const int* vertices, int size, std::vector<int>& sorted) {
  if (size < 3) return true;
  for (int i = 0; i < size; ++i) {
    if (vertices[i] == vertices[(i + 1) % size]) return true;
  }
  if (size == 3) return false;
  sorted.assign(vertices, vertices + size);
  std::sort(sorted.begin(), sorted.end());
  return std::unique(sorted.begin(), sorted.end()) - sorted.begin() < 3;
}

}  // namespace

HalfEdges HalfEdges::of(const PolygonMesh& mesh) {
  HalfEdges result;
  result.mesh_ = mesh;
  result.face_of_corner_.assign(static_cast<std::size_t>(mesh.n_corners()), -1);
  for (int face = 0; face < mesh.n_faces; ++face) {
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) result.face_of_corner_[c] = face;
  }
  result.classify_faces();
  poll(mesh.n_corners());
  result.find_twins();
  return result;
}

void HalfEdges::classify_faces() {
  state_.assign(static_cast<std::size_t>(mesh_.n_faces), FaceState::unselected);
  std::vector<int> sorted;
  for (int face = 0; face < mesh_.n_faces; ++face) {
    if (!mesh_.is_selected(face)) continue;
    const int* vertices = mesh_.corner_vertices + mesh_.face_offsets[face];
    state_[face] = is_degenerate(vertices, mesh_.n_corners(face), sorted) ? FaceState::degenerate : FaceState::used;
  }
}

void HalfEdges::find_twins() {
  constexpr int seam = -1;  // before the half-edges of its edge
  // Repeat if there are duplicates: without them their edges have fewer faces.
  for (int pass = 0; pass < 2; ++pass) {
    twin_.assign(face_of_corner_.size(), -1);
    non_manifold_edges_ = 0;
    // Duplicates lie on an edge of three or more faces, or they are two triangles alone on the same three vertices.
    // (Two larger polygons alone are a closed surface.)
    std::vector<int> suspects;
    const EdgeTable<int> table(mesh_.n_vertices, [&](const auto& visit) {
      for_each_side(mesh_, [&](int c, int next, int face) {
        if (is_used(face)) visit(mesh_.corner_vertices[c], mesh_.corner_vertices[next], c);
      });
      for (int i = 0; i < mesh_.n_seam_edges; ++i) visit(mesh_.seam_edges[i][0], mesh_.seam_edges[i][1], seam);
      poll(n_corners());
    });
    table.for_each_edge([&](const auto& /*ends*/, const auto* first, const auto* last) {
      const bool is_seam = first->value == seam;
      while (first != last && first->value == seam) ++first;
      if (last - first > 2) {
        ++non_manifold_edges_;
        for (auto entry = first; entry != last; ++entry) suspects.push_back(face(entry->value));
      } else if (last - first == 2) {
        const int a = first[0].value;
        const int b = first[1].value;
        if (face(a) == face(b)) return;
        if (mesh_.n_corners(face(a)) == 3 && mesh_.n_corners(face(b)) == 3 && to(next(a)) == to(next(b))) {
          suspects.push_back(face(a));
          suspects.push_back(face(b));
        }
        if (is_seam) return;
        twin_[a] = b;
        twin_[b] = a;
      }
    });
    if (pass == 1 || suspects.empty()) return;
    mark_duplicates(std::move(suspects));
    if (std::find(state_.begin(), state_.end(), FaceState::duplicate) == state_.end()) return;
  }
}

/// Marks, among the candidates with the same vertex set, every face but the first.
void HalfEdges::mark_duplicates(std::vector<int> candidates) {
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::vector<std::pair<std::vector<int>, int>> keys;
  keys.reserve(candidates.size());
  for (const int face : candidates) {
    std::vector<int> key(mesh_.corner_vertices + mesh_.face_offsets[face],
                         mesh_.corner_vertices + mesh_.face_offsets[face + 1]);
    std::sort(key.begin(), key.end());
    keys.emplace_back(std::move(key), face);
  }
  std::sort(keys.begin(), keys.end());
  original_.assign(static_cast<std::size_t>(mesh_.n_faces), -1);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[i - 1].first) continue;
    const int original = original_[keys[i - 1].second];
    original_[keys[i].second] = original < 0 ? keys[i - 1].second : original;
    state_[keys[i].second] = FaceState::duplicate;
  }
}

}  // namespace spectral_conformal
