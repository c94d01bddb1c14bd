#include "mesh/mirror_symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "graph/grouped.h"
#include "graph/mixed_bits.h"

namespace spectral_conformal {
namespace {

/// Limits the candidates around the mirror image of a vertex, and so the cost per vertex of a cluster that the
/// tolerance does not resolve. A pole whose faces have separate vertices has fewer.
constexpr std::ptrdiff_t max_considered = 256;

/// Finds the vertices within a radius of a point, in a grid of cells of twice that radius.
class NearbyVertices {
 public:
  NearbyVertices(const Positions& points, const std::vector<int>& used, double radius)
      : points_(points), radius_(radius), cell_(2 * radius), next_(static_cast<std::size_t>(points.rows()), -1) {
    std::size_t n_buckets = 1;
    while (n_buckets < used.size()) n_buckets *= 2;
    first_.assign(n_buckets, -1);
    for (const int v : used) {
      int& first = first_[bucket(cell_of(points.row(v)))];
      next_[static_cast<std::size_t>(v)] = std::exchange(first, v);
    }
  }
  /// The vertices within the radius, ascending; none if they are too many to distinguish.
  void near(const Eigen::RowVector3d& point, std::vector<int>& result) const {
    result.clear();
    int n_seen = 0;
    const Eigen::RowVector3d reach = Eigen::RowVector3d::Constant(radius_);
    const Cell first = cell_of(point - reach);
    const Cell last = cell_of(point + reach);  // the same cell or the next
    for (std::int64_t x = first[0]; x <= last[0]; ++x) {
      for (std::int64_t y = first[1]; y <= last[1]; ++y) {
        for (std::int64_t z = first[2]; z <= last[2]; ++z) {
          const Cell cell{x, y, z};
          for (int v = first_[bucket(cell)]; v >= 0; v = next_[static_cast<std::size_t>(v)]) {
            // Skip hash collisions.
            if (cell_of(points_.row(v)) != cell) continue;
            if (++n_seen > max_considered) {
              result.clear();
              return;
            }
            if ((points_.row(v) - point).norm() <= radius_) result.push_back(v);
          }
        }
      }
    }
    std::sort(result.begin(), result.end());
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Eigen::RowVector3d& p) const {
    return {static_cast<std::int64_t>(std::floor(p[0] / cell_)), static_cast<std::int64_t>(std::floor(p[1] / cell_)),
            static_cast<std::int64_t>(std::floor(p[2] / cell_))};
  }
  std::size_t bucket(const Cell& cell) const {
    std::uint64_t key = static_cast<std::uint64_t>(cell[0]) * 73856093U ^
                        static_cast<std::uint64_t>(cell[1]) * 19349663U ^
                        static_cast<std::uint64_t>(cell[2]) * 83492791U;
    key *= golden_increment;  // Fibonacci hashing: keys of neighboring cells differ in few bits
    return static_cast<std::size_t>(key >> 32) & (first_.size() - 1);
  }

  const Positions& points_;
  double radius_;
  double cell_;
  std::vector<int> first_;  ///< vertex per bucket, -1 for none
  std::vector<int> next_;   ///< per vertex, the next in its bucket, or -1
};

/// Vertices of selected faces with finite coordinates.
std::vector<int> used_vertices(const PolygonMesh& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.n_vertices), 0);
  for_each_selected_corner(mesh, [&](int c, int /*face*/) { used[mesh.corner_vertices[c]] = 1; });
  std::vector<int> result;
  for (int v = 0; v < mesh.n_vertices; ++v) {
    const double* p = mesh.position(v);
    if (used[v] != 0 && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) result.push_back(v);
  }
  return result;
}

/// The selected faces of each vertex, once per corner, ascending.
using VertexFaces = Grouped<int>;

VertexFaces vertex_faces(const PolygonMesh& mesh) {
  return {mesh.n_vertices, [&](const auto& visit) {
            for_each_selected_corner(mesh, [&](int c, int face) { visit(mesh.corner_vertices[c], face); });
          }};
}

bool share_a_face(const VertexFaces& faces, int a, int b) {
  if (faces[a].size() > faces[b].size()) std::swap(a, b);
  return std::any_of(faces[a].begin(), faces[a].end(),
                     [others = faces[b]](int face) { return std::binary_search(others.begin(), others.end(), face); });
}

/// Chooses among several vertices near the mirror image of a vertex: the one whose faces contain the most images of the
/// vertices of the original's faces. Memory is linear in the corners, for polygons of any size.
class AmbiguousMatch {
 public:
  /// image: (V,), -1 if there is none yet.
  AmbiguousMatch(const PolygonMesh& mesh, const VertexFaces& faces, const std::vector<int>& image)
      : mesh_(mesh),
        faces_(faces),
        image_(image),
        matched_(mesh.n_faces,
                 [&](const auto& visit) {
                   std::vector<int> own;
                   for (int face = 0; face < mesh.n_faces; ++face) {
                     if (!mesh.is_selected(face)) continue;
                     own.clear();
                     for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
                       if (image[mesh.corner_vertices[c]] >= 0) own.push_back(mesh.corner_vertices[c]);
                     }
                     const auto n = static_cast<std::ptrdiff_t>(own.size());
                     const std::ptrdiff_t n_deciding = std::min(n, max_considered);
                     for (std::ptrdiff_t k = 0; k < n_deciding; ++k) {
                       visit(face, own[static_cast<std::size_t>(k * n / n_deciding)]);
                     }
                   }
                 }),
        votes_(image.size(), -1),
        voted_(image.size(), -1) {}
  /// The first of the best candidates.
  int choose(int own, const std::vector<int>& candidates) {
    for (const int candidate : candidates) votes_[candidate] = 0;
    for (const int face : faces_[own]) {
      for (const int matched : matched_[face]) {
        if (matched != own) vote(image_[matched], candidates);
      }
    }
    const int best =
        *std::max_element(candidates.begin(), candidates.end(), [&](int a, int b) { return votes_[a] < votes_[b]; });
    for (const int candidate : candidates) votes_[candidate] = -1;
    return best;
  }

 private:
  /// Adds a vote to the candidates that share a face with `image`, by the cheaper of two searches.
  void vote(int image, const std::vector<int>& candidates) {
    std::size_t n_corners = 0;
    for (const int face : faces_[image]) {
      n_corners += static_cast<std::size_t>(mesh_.n_corners(face));
      if (n_corners > candidates.size()) {
        for (const int candidate : candidates) {
          if (candidate != image && share_a_face(faces_, image, candidate)) ++votes_[candidate];
        }
        return;
      }
    }
    ++vote_;
    for (const int face : faces_[image]) {
      for (int c = mesh_.face_offsets[face]; c < mesh_.face_offsets[face + 1]; ++c) {
        const int other = mesh_.corner_vertices[c];
        if (other == image || votes_[other] < 0 || voted_[other] == vote_) continue;
        voted_[other] = vote_;
        ++votes_[other];
      }
    }
  }

  const PolygonMesh& mesh_;
  const VertexFaces& faces_;
  const std::vector<int>& image_;
  Grouped<int> matched_;             ///< the voting matched vertices of each face
  std::vector<int> votes_;           ///< per vertex, -1 if not a candidate
  std::vector<std::int64_t> voted_;  ///< per vertex, the last vote that counted it
  std::int64_t vote_ = -1;
};

/// Matches the vertices across one plane. Keeps only mutual pairs.
void match_vertices(const PolygonMesh& mesh, const Positions& points, const std::vector<int>& used,
                    const NearbyVertices& nearby, const VertexFaces& faces, MirrorSymmetry& result) {
  std::vector<int> image(static_cast<std::size_t>(points.rows()), -1);
  std::vector<int> near;
  const auto find_near = [&](int v) {
    Eigen::RowVector3d mirrored = points.row(v);
    mirrored[result.axis] = -mirrored[result.axis];
    nearby.near(mirrored, near);
  };
  std::vector<int> ambiguous;
  for (const int v : used) {
    poll();
    find_near(v);
    if (near.size() == 1) image[v] = near.front();
    if (near.size() > 1) ambiguous.push_back(v);
  }
  if (!ambiguous.empty()) {
    std::vector<int> chosen;
    chosen.reserve(ambiguous.size());
    AmbiguousMatch match(mesh, faces, image);
    for (const int v : ambiguous) {
      poll();
      // Search again: storing all lists would take more memory than the mesh.
      find_near(v);
      chosen.push_back(match.choose(v, near));
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) image[ambiguous[i]] = chosen[i];
  }
  result.vertex.assign(image.size(), -1);
  result.side.assign(image.size(), 0);
  for (const int v : used) {
    if (image[v] >= 0 && image[image[v]] == v) result.vertex[v] = image[v];
    if (result.vertex[v] != v) result.side[v] = points(v, result.axis) < 0 ? -1 : 1;
  }
}

/// Finds the selected faces by their vertices.
class FacesByVertices {
 public:
  explicit FacesByVertices(const PolygonMesh& mesh) : mesh_(mesh) {
    for (int face = 0; face < mesh.n_faces; ++face) {
      if (mesh.is_selected(face)) faces_.emplace_back(key_of(vertices_of(face)), face);
    }
    std::sort(faces_.begin(), faces_.end());
  }
  /// The first face with these vertices in any order, or -1. Sorts `vertices`.
  int find(std::vector<int>& vertices) const {
    const std::uint64_t key = key_of(vertices);
    std::sort(vertices.begin(), vertices.end());
    for (auto it = std::lower_bound(faces_.begin(), faces_.end(), std::pair(key, -1));
         it != faces_.end() && it->first == key; ++it) {
      std::vector<int> own = vertices_of(it->second);
      std::sort(own.begin(), own.end());
      if (own == vertices) return it->second;
    }
    return -1;
  }

 private:
  std::vector<int> vertices_of(int face) const {
    return {mesh_.corner_vertices + mesh_.face_offsets[face], mesh_.corner_vertices + mesh_.face_offsets[face + 1]};
  }
  /// Independent of the order of the vertices.
  static std::uint64_t key_of(const std::vector<int>& vertices) {
    std::uint64_t key = vertices.size();
    for (const int v : vertices) key += mixed_bits((static_cast<std::uint64_t>(v) + 1) * golden_increment);
    return key;
  }

  const PolygonMesh& mesh_;
  std::vector<std::pair<std::uint64_t, int>> faces_;  ///< sorted
};

/// Returns the number of faces with an image.
int match_faces(const PolygonMesh& mesh, const FacesByVertices& faces, MirrorSymmetry& result) {
  int matched = 0;
  std::vector<int> mirrored;
  for (int face = 0; face < mesh.n_faces; ++face) {
    poll();
    if (!mesh.is_selected(face)) continue;
    mirrored.clear();
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      mirrored.push_back(result.vertex[mesh.corner_vertices[c]]);
    }
    if (mirrored.empty() || std::find(mirrored.begin(), mirrored.end(), -1) != mirrored.end()) continue;
    result.face[face] = faces.find(mirrored);
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
  // Relative to the center and the extent, so that grid cells have small numbers.
  Positions points = Positions::Zero(mesh.n_vertices, 3);
  for (const int v : used) points.row(v) = (given.row(v) - (low + 0.5 * (high - low))) / extent;
  const NearbyVertices nearby(points, used, tolerance * (high - low).norm() / extent);
  const VertexFaces faces = vertex_faces(mesh);
  const FacesByVertices faces_by_vertices(mesh);
  std::array<MirrorSymmetry, 3> candidates;
  std::array<int, 3> matched{};
  run_in_parallel(
      3,
      [&](int axis, const Progress&) {
        candidates[axis] = {axis, {}, no_image(static_cast<std::size_t>(mesh.n_faces)), {}};
        match_vertices(mesh, points, used, nearby, faces, candidates[axis]);
        matched[axis] = match_faces(mesh, faces_by_vertices, candidates[axis]);
      },
      {}, "");
  const auto most = std::max_element(matched.begin(), matched.end());  // the first of equal axes
  return *most > 0 ? std::move(candidates[most - matched.begin()]) : best;
}

}  // namespace spectral_conformal
