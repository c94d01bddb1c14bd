#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "seams/pieces.h"

namespace spectral_conformal {

/// Of a polygon, in their order.
class Corners {
 public:
  Corners(const int* first, int n) : first_(first), n_(n) {}
  explicit Corners(const std::vector<int>& corners) : Corners(corners.data(), static_cast<int>(corners.size())) {}

  const int* begin() const { return first_; }
  const int* end() const { return first_ + n_; }
  int size() const { return n_; }
  int operator[](int c) const { return first_[c]; }
  bool contains(int v) const { return std::find(begin(), end(), v) != end(); }
  /// Those before and after one.
  std::array<int, 2> beside(int v) const {
    const int* at = std::find(begin(), end(), v);
    return {at == begin() ? first_[n_ - 1] : *(at - 1), at + 1 == end() ? *first_ : *(at + 1)};
  }

 private:
  const int* first_;
  int n_;
};

/// The polygons of a piece while vertices are merged into others, and what merges keep its topology. Large polygons,
/// and vertices of many faces (hubs), only follow what is merged beside them: to look at all of one at every merge
/// there would take quadratic time. Beside a large polygon vertices are merged as on the boundary.
class ShrinkingMesh {
 public:
  /// An edge of the boundary, and its face.
  struct BoundaryEdge {
    std::array<int, 2> vertices;
    int face;
  };
  /// What a merge of a vertex changes.
  struct Surroundings {
    std::vector<int> vertices;  ///< of the faces around it
    std::vector<std::vector<int>> faces_of;
    std::vector<int> n_faces;
    std::vector<std::vector<int>> corners;  ///< of the faces around it
  };

  /// The piece must outlive this object.
  explicit ShrinkingMesh(const Piece& fine);

  /// How many are left.
  int n_vertices() const { return n_left_; }
  bool is_left(int v) const { return into_[v] == v; }
  /// Per vertex: the one that it was merged into in the end.
  std::vector<int> roots() const;
  /// Of a face; none where it has vanished. One with many keeps them all, also those that were merged.
  Corners corners(int face) const { return {corners_.data() + fine_.face_offsets[face], n_corners_[face]}; }
  /// None of a hub.
  const std::vector<int>& faces_of(int v) const { return faces_of_[v]; }
  bool is_hub(int v) const { return n_faces_[v] > 0 && faces_of_[v].empty(); }
  /// Hubs, the vertices of seams, and those that no simple fan surrounds.
  bool stays(int v) const { return border_[v] == 2; }
  const std::vector<BoundaryEdge>& boundary() const { return boundary_; }

  /// The vertices joined to v by an edge, ascending, each once per face beside the edge.
  void collect_neighbors(int v, std::vector<int>& neighbors) const;
  /// Whether the faces around a vertex with these neighbors are one fan, closed inside and open on the boundary.
  bool is_simple_fan(int v, const std::vector<int>& neighbors) const;
  /// Whether the topology stays if a vertex with a simple fan and these neighbors is merged into one of them, and this
  /// one gets no fan of thin triangles. `others` is scratch.
  bool can_merge(int v, int w, const std::vector<int>& neighbors, std::vector<int>& others) const;
  void merge(int v, int w);
  Surroundings surroundings(int v) const;
  /// Takes a merge of a vertex back, with what surrounded it before.
  void restore(int v, const Surroundings& before);

 private:
  const Piece& fine_;
  std::vector<int> corners_;                ///< those of a face from its offset in the fine piece on
  std::vector<int> n_corners_;              ///< per face
  std::vector<std::vector<int>> faces_of_;  ///< per vertex, without large polygons
  std::vector<int> n_faces_;                ///< per vertex, so counted
  std::vector<char> border_;                ///< per vertex: 1 on the boundary, 2 where it has to stay
  std::vector<BoundaryEdge> boundary_;
  std::vector<int> into_;
  int n_left_;
};

}  // namespace spectral_conformal
