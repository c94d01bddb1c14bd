#include "seams/congruent_pieces.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "mesh/edge_table.h"
#include "mesh/half_edges.h"

namespace spectral_conformal {
namespace {

/// Of positions, relative to a piece's size: exceeds the errors of single precision of small parts in large scenes.
constexpr double tolerance = 1e-4;
/// Of means of distances over the largest of them.
constexpr double moment_tolerance = 3 * tolerance;
/// Of sizes that are told apart.
constexpr double steps_per_octave = 1024;
/// Corners visited for one pair of pieces, over the corners of each. Most false starts end at once.
constexpr std::int64_t max_visits = 64;

/// A piece with what no motion changes, in units of its size.
class RigidShape {
 public:
  explicit RigidShape(const Piece& piece) : piece_(piece), points_(piece.positions) {
    points_.rowwise() -= piece.positions.colwise().mean();
    distances_ = points_.rowwise().norm();
    size_ = distances_.maxCoeff(&farthest_);
    points_ /= size_;
    distances_ /= size_;
    double edges = 0;
    for (int f = 0; f < piece.n_faces(); ++f) {
      const int end = piece.face_offsets[f + 1];
      for (int c = piece.face_offsets[f], last = end - 1; c < end; last = c++) {
        edges += (points_.row(piece.corner_vertices[c]) - points_.row(piece.corner_vertices[last])).norm();
      }
    }
    const auto n = static_cast<double>(piece.vertices.size());
    moments_ = {distances_.norm() / std::sqrt(n), distances_.mean(), edges / piece.corner_vertices.size()};
  }

  const Piece& piece() const { return piece_; }
  /// The largest distance from the centroid.
  double size() const { return size_; }
  /// Equal for shapes that a similarity maps onto each other.
  const Eigen::Array3d& moments() const { return moments_; }

  /// The vertices of `other` onto which a similarity maps those of this piece, if one does and
  /// `is_wanted(vertices, rotation)`.
  template <class IsWanted>
  std::optional<std::vector<int>> mapped_onto(const RigidShape& other, const IsWanted& is_wanted) {
    if (!edges_) edges_ = HalfEdges::of(piece_.view());
    const HalfEdges others = HalfEdges::of(other.piece_.view());
    const auto first = std::find(piece_.corner_vertices.begin(), piece_.corner_vertices.end(), farthest_);
    const int start = static_cast<int>(first - piece_.corner_vertices.begin());
    std::int64_t left = max_visits * others.n_corners();
    for (int c = 0; c < others.n_corners() && left > 0; ++c) {
      poll();
      const std::vector<int> vertices = matched(start, other, others, c, left);
      if (vertices.empty() || !has_seams(vertices, other)) continue;
      const Eigen::Matrix3d rotation = rotation_onto(other, vertices);
      if (is_near(other, vertices, rotation) && is_wanted(vertices, rotation)) return vertices;
    }
    return std::nullopt;
  }

 private:
  /// Walks on both pieces at once, from one corner each. Returns the vertices of the other piece, empty if distances,
  /// faces or neighbors differ. Reduces the number of visits left.
  std::vector<int> matched(int start, const RigidShape& other, const HalfEdges& others, int image,
                           std::int64_t& left) const {
    std::vector<int> vertices;
    std::vector<char> is_used;
    std::vector<int> corner(static_cast<std::size_t>(edges_->n_corners()), -1);  // of the other piece
    std::vector<int> todo;
    const auto visit = [&](int one, int two) {
      if (one < 0 || two < 0) return one == two;
      if (corner[one] >= 0) return corner[one] == two;
      --left;
      count_steps(1);
      const int v = edges_->from(one);
      const int w = others.from(two);
      if (std::abs(distances_[v] - other.distances_[w]) > tolerance) return false;
      if (std::abs(length(*edges_, one) - other.length(others, two)) > 2 * tolerance) return false;
      if (vertices.empty()) {
        vertices.assign(piece_.vertices.size(), -1);
        is_used.assign(vertices.size(), 0);
      }
      if (vertices[v] < 0 && is_used[w] == 0) {
        vertices[v] = w;
        is_used[w] = 1;
      }
      if (vertices[v] != w) return false;
      corner[one] = two;
      todo.push_back(one);
      return true;
    };
    if (!visit(start, image)) return {};
    while (!todo.empty()) {
      const int one = todo.back();
      const int two = corner[one];
      todo.pop_back();
      const int twin = edges_->twin(one);
      const bool is_same = visit(edges_->next(one), others.next(two)) && visit(twin, others.twin(two)) &&
                           (twin < 0 || edges_->is_opposed(one) == others.is_opposed(two));
      if (!is_same) return {};
    }
    const bool is_whole = std::find(corner.begin(), corner.end(), -1) == corner.end() &&
                          std::find(vertices.begin(), vertices.end(), -1) == vertices.end();
    return is_whole ? vertices : std::vector<int>{};
  }

  double length(const HalfEdges& edges, int corner) const {
    return (points_.row(edges.from(corner)) - points_.row(edges.to(corner))).norm();
  }

  bool has_seams(const std::vector<int>& vertices, const RigidShape& other) const {
    const auto& wanted = other.piece_.seams;
    return piece_.seams.size() == wanted.size() &&
           std::all_of(piece_.seams.begin(), piece_.seams.end(), [&](const auto& seam) {
             return std::binary_search(wanted.begin(), wanted.end(),
                                       edge_between(vertices[seam[0]], vertices[seam[1]]));
           });
  }

  /// In the sense of least squares (Kabsch 1976).
  Eigen::Matrix3d rotation_onto(const RigidShape& other, const std::vector<int>& vertices) const {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      covariance += other.points_.row(vertices[v]).transpose() * points_.row(static_cast<Eigen::Index>(v));
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  }

  bool is_near(const RigidShape& other, const std::vector<int>& vertices, const Eigen::Matrix3d& rotation) const {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Eigen::RowVector3d moved = points_.row(static_cast<Eigen::Index>(v)) * rotation.transpose();
      if (!((moved - other.points_.row(vertices[v])).norm() <= tolerance)) return false;
    }
    return true;
  }

  const Piece& piece_;
  Positions points_;           ///< (V, 3) relative to the centroid
  Eigen::VectorXd distances_;  ///< (V,) from the centroid
  double size_ = 0;
  Eigen::Index farthest_ = 0;  ///< a vertex
  Eigen::Array3d moments_;
  std::optional<HalfEdges> edges_;  ///< once they are needed
};

/// Finds the copies in one pass over the pieces.
class CopySearch {
 public:
  CopySearch(const MirroredPieces& parts, const SeamPreferences& preferences, bool any_size)
      : parts_(parts), preferences_(preferences), any_size_(any_size), copies_(parts.pieces.size()) {}

  std::vector<PieceCopy> run() {
    for (const int i : order()) {
      const Piece& piece = parts_.pieces[i];
      if (copies_[i].source < 0 && !(has_extent(piece) && takes_from_another(i))) copies_[i].source = i;
      const int image = parts_.mirrors[i].image;
      if (image == i || image < 0 || copies_[image].source >= 0) continue;
      copies_[image] = composed(i, parts_.mirrors[i].vertex);
      add_known(image);
    }
    return std::move(copies_);
  }

 private:
  /// Their own mirror images first, then large ones: a small copy does not exceed the sheet where a large one fits.
  /// Sizes that differ by rounding are equal.
  std::vector<int> order() const {
    std::vector<std::array<double, 2>> keys;
    double largest = 0;
    for (std::size_t i = 0; i < parts_.pieces.size(); ++i) {
      const Piece& piece = parts_.pieces[i];
      const double size = has_extent(piece) ? RigidShape(piece).size() : 0;
      largest = std::max(largest, size);
      keys.push_back({parts_.mirrors[i].image == static_cast<int>(i) ? 0.0 : 1.0, size});
    }
    for (auto& [kind, size] : keys) {
      size = size > 0 ? -std::round(steps_per_octave * std::log2(size / largest)) : infinity;
    }
    std::vector<int> result(keys.size());
    std::iota(result.begin(), result.end(), 0);
    std::stable_sort(result.begin(), result.end(), [&](int a, int b) { return keys[a] < keys[b]; });
    return result;
  }

  /// The copy onto which `vertex` maps the piece i.
  PieceCopy composed(int i, const std::vector<int>& vertex) const {
    PieceCopy result = copies_[i];
    if (result.vertex.empty()) {
      result.vertex = vertex;
    } else {
      for (int& v : result.vertex) v = vertex[v];
    }
    return result;
  }

  bool takes_from_another(int i) {
    const Piece& piece = parts_.pieces[i];
    const RigidShape shape(piece);
    ByMoment& known = known_[counts(piece)];
    const double moment = shape.moments()[0];
    const auto last = known.upper_bound(moment + moment_tolerance);
    for (auto other = known.lower_bound(moment - moment_tolerance); other != last; ++other) {
      poll();
      Known& candidate = other->second;
      const double ratio = shape.size() / candidate.shape.size();
      if (((shape.moments() - candidate.shape.moments()).abs() > moment_tolerance).any() ||
          (!any_size_ && std::abs(ratio - 1) > moment_tolerance)) {
        continue;
      }
      const auto vertices =
          candidate.shape.mapped_onto(shape, [&](const std::vector<int>& vertex, const Eigen::Matrix3d& rotation) {
            return keeps_mirror(candidate.piece, i, vertex) &&
                   preferences_.agree(candidate.shape.piece(), piece, vertex, rotation);
          });
      if (!vertices) continue;
      copies_[i] = composed(candidate.piece, *vertices);
      return true;
    }
    add_known(i);
    return false;
  }

  void add_known(int i) {
    RigidShape shape(parts_.pieces[i]);
    const double moment = shape.moments()[0];
    known_[counts(parts_.pieces[i])].emplace(moment, Known{i, std::move(shape)});
  }

  static std::array<std::size_t, 4> counts(const Piece& piece) {
    return {piece.vertices.size(), piece.faces.size(), piece.corner_vertices.size(), piece.seams.size()};
  }

  /// Whether symmetric seams stay symmetric, where the piece is its own mirror image.
  bool keeps_mirror(int source, int copy, const std::vector<int>& vertex) const {
    const PieceMirror& of_source = parts_.mirrors[source];
    const PieceMirror& of_copy = parts_.mirrors[copy];
    if (of_copy.image != copy) return true;
    if (of_source.image != source) return false;
    for (std::size_t v = 0; v < vertex.size(); ++v) {
      if (vertex[of_source.vertex[v]] != of_copy.vertex[vertex[v]]) return false;
    }
    return true;
  }

  struct Known {
    int piece;
    RigidShape shape;
  };
  using ByMoment = std::multimap<double, Known>;

  const MirroredPieces& parts_;
  const SeamPreferences& preferences_;
  bool any_size_;
  std::vector<PieceCopy> copies_;
  std::map<std::array<std::size_t, 4>, ByMoment> known_;  ///< no copies but mirror images, per counts()
};

}  // namespace

std::vector<PieceCopy> copies_of_pieces(const MirroredPieces& parts, const SeamPreferences& preferences,
                                        bool any_size) {
  return CopySearch(parts, preferences, any_size).run();
}

}  // namespace spectral_conformal
