#include "mesh/mirror_symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "graph/parallel_calls.h"

namespace spectral_conformal {
namespace {

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
  /// Those within the radius, ascending.
  std::vector<int> near(const Eigen::RowVector3d& point) const {
    std::vector<int> result;
    const Eigen::RowVector3d reach = Eigen::RowVector3d::Constant(radius_);
    const Cell first = cell_of(point - reach);
    const Cell last = cell_of(point + reach);  // the same or the next one
    for (std::int64_t x = first[0]; x <= last[0]; ++x) {
      for (std::int64_t y = first[1]; y <= last[1]; ++y) {
        for (std::int64_t z = first[2]; z <= last[2]; ++z) {
          for (int v = first_[bucket({x, y, z})]; v >= 0; v = next_[static_cast<std::size_t>(v)]) {
            if ((points_.row(v) - point).norm() <= radius_) result.push_back(v);
          }
        }
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
  /// Vertices of several cells in one bucket are told apart by their distances.
  std::size_t bucket(const Cell& cell) const {
    std::uint64_t key = static_cast<std::uint64_t>(cell[0]) * 73856093U ^
                        static_cast<std::uint64_t>(cell[1]) * 19349663U ^
                        static_cast<std::uint64_t>(cell[2]) * 83492791U;
    key *= 0x9E3779B97F4A7C15U;  // Fibonacci hashing: neighbouring cells have keys that differ in few bits
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
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) used[mesh.corner_vertices[c]] = 1;
  }
  std::vector<int> result;
  for (int v = 0; v < mesh.n_vertices; ++v) {
    const double* p = mesh.positions + 3 * static_cast<std::size_t>(v);
    if (used[v] != 0 && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) result.push_back(v);
  }
  return result;
}

/// The selected faces of each vertex, once per corner.
class VertexFaces {
 public:
  explicit VertexFaces(const PolygonMesh& mesh) : start_(static_cast<std::size_t>(mesh.n_vertices) + 1, 0) {
    const auto each = [&](auto&& visit) {
      for (int face = 0; face < mesh.n_faces; ++face) {
        if (!mesh.is_selected(face)) continue;
        for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c)
          visit(mesh.corner_vertices[c], face);
      }
    };
    each([&](int vertex, int) { ++start_[vertex + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    faces_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<int> fill(start_.begin(), start_.end() - 1);
    each([&](int vertex, int face) { faces_[fill[vertex]++] = face; });
  }
  const int* begin(int vertex) const { return faces_.data() + start_[vertex]; }
  const int* end(int vertex) const { return faces_.data() + start_[static_cast<std::size_t>(vertex) + 1]; }
  int count(int vertex) const { return static_cast<int>(end(vertex) - begin(vertex)); }
  bool share_a_face(int a, int b) const {
    if (count(a) > count(b)) std::swap(a, b);
    // Ascending, as they were entered.
    return std::any_of(begin(a), end(a), [&](int face) { return std::binary_search(begin(b), end(b), face); });
  }

 private:
  std::vector<int> start_;
  std::vector<int> faces_;
};

/// Of several vertices near the mirror image of a vertex, the one whose faces have most vertices that are images of the
/// own faces' vertices. Memory is linear in the corners, so that polygons may have any number of them.
class AmbiguousMatch {
 public:
  /// image (V,): -1 where there is none yet.
  AmbiguousMatch(const PolygonMesh& mesh, const VertexFaces& faces, const std::vector<int>& image)
      : faces_(faces), image_(image), start_(static_cast<std::size_t>(mesh.n_faces) + 1, 0) {
    for (int face = 0; face < mesh.n_faces; ++face) {
      if (mesh.is_selected(face)) {
        for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
          if (image[mesh.corner_vertices[c]] >= 0) matched_.push_back(mesh.corner_vertices[c]);
        }
      }
      start_[static_cast<std::size_t>(face) + 1] = static_cast<int>(matched_.size());
    }
  }
  /// The first of the best candidates.
  int choose(int own, const std::vector<int>& candidates) const {
    int best = candidates.front();
    std::ptrdiff_t max_common = -1;
    for (const int candidate : candidates) {
      const std::ptrdiff_t n_common = common(own, candidate);
      if (n_common <= max_common) continue;
      max_common = n_common;
      best = candidate;
    }
    return best;
  }

 private:
  std::ptrdiff_t common(int own, int candidate) const {
    std::ptrdiff_t result = 0;
    for (const int* face = faces_.begin(own); face != faces_.end(own); ++face) {
      for (int i = start_[*face]; i < start_[*face + 1]; ++i) {
        const int image = image_[matched_[i]];
        result += matched_[i] != own && image != candidate && faces_.share_a_face(image, candidate) ? 1 : 0;
      }
    }
    return result;
  }

  const VertexFaces& faces_;
  const std::vector<int>& image_;
  std::vector<int> start_;    ///< per face, into matched_
  std::vector<int> matched_;  ///< the vertices of each face that have an image
};

/// Matches the vertices across one plane. Only pairs that name each other are kept.
void match_vertices(const PolygonMesh& mesh, const Positions& points, const std::vector<int>& used,
                    const NearbyVertices& nearby, const VertexFaces& faces, MirrorSymmetry& result) {
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
  chosen.reserve(ambiguous.size());
  const AmbiguousMatch match(mesh, faces, image);
  for (const auto& [v, candidates] : ambiguous) chosen.push_back(match.choose(v, candidates));
  for (std::size_t i = 0; i < chosen.size(); ++i) image[ambiguous[i].first] = chosen[i];
  result.vertex.assign(image.size(), -1);
  result.side.assign(image.size(), 0);
  for (const int v : used) {
    if (image[v] >= 0 && image[image[v]] == v) result.vertex[v] = image[v];
    if (result.vertex[v] != v) result.side[v] = points(v, result.axis) < 0 ? -1 : 1;
  }
}

/// The face with these vertices, ascending, the first of several, or -1.
int face_of(const PolygonMesh& mesh, const VertexFaces& faces, const std::vector<int>& vertices) {
  const int rarest = *std::min_element(vertices.begin(), vertices.end(),
                                       [&](int a, int b) { return faces.count(a) < faces.count(b); });
  std::vector<int> own;
  const int* const found = std::find_if(faces.begin(rarest), faces.end(rarest), [&](int face) {
    own.assign(mesh.corner_vertices + mesh.face_offsets[face], mesh.corner_vertices + mesh.face_offsets[face + 1]);
    std::sort(own.begin(), own.end());
    return own == vertices;
  });
  return found == faces.end(rarest) ? -1 : *found;
}

/// Returns how many have an image.
int match_faces(const PolygonMesh& mesh, const VertexFaces& faces, MirrorSymmetry& result) {
  int matched = 0;
  std::vector<int> mirrored;
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (!mesh.is_selected(face)) continue;
    mirrored.clear();
    for (int c = mesh.face_offsets[face]; c < mesh.face_offsets[face + 1]; ++c) {
      mirrored.push_back(result.vertex[mesh.corner_vertices[c]]);
    }
    if (mirrored.empty() || std::find(mirrored.begin(), mirrored.end(), -1) != mirrored.end()) continue;
    std::sort(mirrored.begin(), mirrored.end());
    result.face[face] = face_of(mesh, faces, mirrored);
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
  const VertexFaces faces(mesh);
  std::array<MirrorSymmetry, 3> candidates;
  std::array<int, 3> matched{};
  run_in_parallel(
      3,
      [&](int axis, const Progress&) {
        candidates[axis] = {axis, {}, no_image(static_cast<std::size_t>(mesh.n_faces)), {}};
        match_vertices(mesh, points, used, nearby, faces, candidates[axis]);
        matched[axis] = match_faces(mesh, faces, candidates[axis]);
      },
      {}, "");
  const auto most = std::max_element(matched.begin(), matched.end());  // the first axis of equals
  return *most > 0 ? std::move(candidates[most - matched.begin()]) : best;
}

}  // namespace spectral_conformal
