#include "seams/shrinking_mesh.h"

#include <cstddef>
#include <numeric>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "mesh/half_edges.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {
namespace {

/// Most faces around a vertex: more would be a fan of thin triangles, whose maps say nothing about the fine ones.
constexpr std::size_t max_faces_around = 14;

}  // namespace

ShrinkingMesh::ShrinkingMesh(const Piece& fine)
    : fine_(fine),
      corners_(fine.corner_vertices),
      faces_of_(fine.vertices.size()),
      n_faces_(fine.vertices.size(), 0),
      border_(fine.vertices.size(), 0),
      into_(fine.vertices.size()),
      n_left_(static_cast<int>(fine.vertices.size())) {
  std::iota(into_.begin(), into_.end(), 0);
  const HalfEdges half_edges = HalfEdges::of(fine.view());
  for (int f = 0; f < fine.n_faces(); ++f) n_corners_.push_back(fine.face_offsets[f + 1] - fine.face_offsets[f]);
  const auto is_large = [&](int face) { return n_corners_[face] > hub_size; };
  for (int c = 0; c < half_edges.n_corners(); ++c) n_faces_[corners_[c]] += is_large(half_edges.face(c)) ? 0 : 1;
  for (std::size_t v = 0; v < n_faces_.size(); ++v) {
    if (n_faces_[v] > hub_size) {
      border_[v] = 2;
    } else {
      faces_of_[v].reserve(static_cast<std::size_t>(n_faces_[v]));
    }
  }
  for (int c = 0; c < half_edges.n_corners(); ++c) {
    const int f = half_edges.face(c);
    const int v = corners_[c];
    if (!is_large(f) && border_[v] != 2) faces_of_[v].push_back(f);
  }
  for_each_polled(half_edges.n_corners(), [&](int c) {
    const int f = half_edges.face(c);
    const int twin = half_edges.twin(c);
    if (twin >= 0 && !is_large(half_edges.face(twin))) return;
    const std::array<int, 2> edge{half_edges.from(c), half_edges.to(c)};
    for (const int v : edge) border_[v] = std::max<char>(border_[v], is_large(f) ? 2 : 1);
    if (!is_large(f)) boundary_.push_back({edge, f});
  });
  for (const auto& seam : fine.seams) border_[seam[0]] = border_[seam[1]] = 2;
}

std::vector<int> ShrinkingMesh::roots() const {
  std::vector<int> result = into_;
  for (int& v : result) {
    while (into_[v] != v) v = into_[v];
  }
  return result;
}

void ShrinkingMesh::collect_neighbors(int v, std::vector<int>& neighbors) const {
  neighbors.clear();
  for (const int f : faces_of_[v]) {
    count_steps(corners(f).size());
    for (const int w : corners(f).beside(v)) neighbors.push_back(w);
  }
  std::sort(neighbors.begin(), neighbors.end());
}

bool ShrinkingMesh::is_simple_fan(int v, const std::vector<int>& neighbors) const {
  int open = 0;
  for (auto at = neighbors.begin(); at != neighbors.end();) {
    const auto next = std::find_if(at, neighbors.end(), [&](int w) { return w != *at; });
    if (next - at > 2) return false;
    if (next - at == 1) ++open;
    at = next;
  }
  return open == (border_[v] != 0 ? 2 : 0);
}

/// Common neighbors must be third vertices of the triangles that vanish, and must keep enough faces. A hub loses less
/// than half of its faces to merges without common vertices.
bool ShrinkingMesh::can_merge(int v, int w, const std::vector<int>& neighbors, std::vector<int>& others) const {
  const auto at_edge = std::equal_range(neighbors.begin(), neighbors.end(), w);
  if (is_hub(w) || at_edge.first == at_edge.second) return false;
  if (border_[v] != 0 && at_edge.second - at_edge.first != 1) return false;
  std::size_t triangles = 0;
  std::size_t shared = 0;
  for (const int f : faces_of_[v]) {
    const Corners corners = this->corners(f);
    if (!corners.contains(w)) continue;
    const auto [previous, next] = corners.beside(w);
    if (next != v && previous != v) return false;
    ++shared;
    if (corners.size() > 3) continue;
    ++triangles;
    const int third = next == v ? previous : next;
    if (n_faces_[third] < (is_hub(third) ? 8 : border_[third] == 1 ? 2 : 4)) return false;
  }
  if (faces_of_[v].size() + faces_of_[w].size() - 2 * shared > max_faces_around) return false;
  collect_neighbors(w, others);
  others.erase(std::unique(others.begin(), others.end()), others.end());
  const auto common = std::count_if(others.begin(), others.end(), [&](int other) {
    return std::binary_search(neighbors.begin(), neighbors.end(), other);
  });
  return triangles == static_cast<std::size_t>(common);
}

void ShrinkingMesh::merge(int v, int w) {
  for (const int f : faces_of_[v]) {
    const Corners corners = this->corners(f);
    int* const first = corners_.data() + fine_.face_offsets[f];
    if (!corners.contains(w)) {
      std::replace(first, first + corners.size(), v, w);
      faces_of_[w].push_back(f);
      ++n_faces_[w];
      continue;
    }
    n_corners_[f] = static_cast<int>(std::remove(first, first + corners.size(), v) - first);
    if (n_corners_[f] > 2) continue;
    for (const int c : this->corners(f)) {
      if (!is_hub(c)) faces_of_[c].erase(std::find(faces_of_[c].begin(), faces_of_[c].end(), f));
      --n_faces_[c];
    }
    n_corners_[f] = 0;
  }
  faces_of_[v].clear();
  n_faces_[v] = 0;
  into_[v] = w;
  --n_left_;
}

}  // namespace spectral_conformal
