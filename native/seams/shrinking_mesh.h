#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "seams/pieces.h"

namespace spectral_conformal {

/// The corners of a polygon, in order.
class Corners {
 public:
  Corners(const int* first, int n) : first_(first), n_(n) {}
  explicit Corners(const std::vector<int>& corners) : Corners(corners.data(), static_cast<int>(corners.size())) {}

  const int* begin() const { return first_; }
  const int* end() const { return first_ + n_; }
  int size() const { return n_; }
  int operator[](int c) const { return first_[c]; }
  bool contains(int v) const { return std::find(begin(), end(), v) != end(); }
  /// The corners before and after `v`, which must be one of them.
  std::array<int, 2> beside(int v) const {
    const int* at = std::find(begin(), end(), v);
    return {at == begin() ? first_[n_ - 1] : *(at - 1), at + 1 == end() ? *first_ : *(at + 1)};
  }

 private:
  const int* first_;
  int n_;
};

/// The polygons of a piece while vertices are merged into neighbors, and tests for merges that keep its topology. Large
/// polygons and vertices with many faces (hubs) only follow the merges next to them: visiting all of one at every merge
/// would take quadratic time. Vertices of a large polygon are merged as on the boundary.
class ShrinkingMesh {
 public:
  /// An edge of the boundary, and its face.
  struct BoundaryEdge {
    std::array<int, 2> vertices;
    int face;
  };
  /// The piece must outlive this object.
  explicit ShrinkingMesh(const Piece& fine);

  /// The number of vertices left.
  int n_vertices() const { return n_left_; }
  bool is_left(int v) const { return into_[v] == v; }
  /// For each vertex of the piece, the vertex that it was finally merged into.
  std::vector<int> roots() const;
  /// The corners of a face; none once it has vanished. A large face keeps all of them, even merged ones.
  Corners corners(int face) const { return {corners_.data() + fine_.face_offsets[face], n_corners_[face]}; }
  /// The faces around a vertex, without large ones; none for a hub.
  const std::vector<int>& faces_of(int v) const { return faces_of_[v]; }
  /// The number of faces around a vertex, without large ones.
  int n_faces(int v) const { return n_faces_[v]; }
  bool is_hub(int v) const { return n_faces_[v] > 0 && faces_of_[v].empty(); }
  /// Whether a vertex must stay: hubs, vertices of seams, and the ends of edges that have only large faces.
  bool stays(int v) const { return border_[v] == 2; }
  const std::vector<BoundaryEdge>& boundary() const { return boundary_; }

  /// The neighbors of v, ascending, each once per face of the edge to it.
  void collect_neighbors(int v, std::vector<int>& neighbors) const;
  /// Whether the faces around a vertex with these neighbors form one fan, closed inside and open on the boundary.
  bool is_simple_fan(int v, const std::vector<int>& neighbors) const;
  /// Whether merging v, which has a simple fan and these neighbors, into w keeps the topology and gives w no fan of
  /// thin triangles. `others` is scratch.
  bool can_merge(int v, int w, const std::vector<int>& neighbors, std::vector<int>& others) const;
  void merge(int v, int w);

 private:
  const Piece& fine_;
  std::vector<int> corners_;                ///< those of a face from its offset in the fine piece
  std::vector<int> n_corners_;              ///< per face
  std::vector<std::vector<int>> faces_of_;  ///< per vertex, without large polygons
  std::vector<int> n_faces_;                ///< per vertex, without large polygons, also for hubs
  std::vector<char> border_;                ///< per vertex: 1 on the boundary, 2 if it must stay
  std::vector<BoundaryEdge> boundary_;
  std::vector<int> into_;
  int n_left_;
};

}  // namespace spectral_conformal
