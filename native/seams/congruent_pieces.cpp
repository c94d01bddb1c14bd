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
    for_each_side(piece.view(), [&](int c, int next, int /*face*/) {
      edges += (points_.row(piece.corner_vertices[next]) - points_.row(piece.corner_vertices[c])).norm();
    });
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
    Matching matching(piece_);
    std::int64_t left = max_visits * others.n_corners();
    for (int c = 0; c < others.n_corners() && left > 0; ++c) {
      poll();
      const bool is_whole = match(start, other, others, c, matching);
      left -= static_cast<std::int64_t>(matching.visited.size()) + 1;
      if (is_whole && has_seams(matching.vertex, other)) {
        const Eigen::Matrix3d rotation = rotation_onto(other, matching.vertex);
        if (is_near(other, matching.vertex, rotation) && is_wanted(matching.vertex, rotation)) return matching.vertex;
      }
      matching.clear(*edges_, others);
    }
    return std::nullopt;
  }

 private:
  /// What a walk has matched. Most end early, so that only what they visited is cleared.
  struct Matching {
    explicit Matching(const Piece& piece)
        : vertex(piece.vertices.size(), -1),
          corner(piece.corner_vertices.size(), -1),
          is_image(piece.vertices.size(), 0) {}

    void clear(const HalfEdges& edges, const HalfEdges& others) {
      for (const int c : visited) {
        vertex[edges.from(c)] = -1;
        is_image[others.from(corner[c])] = 0;
        corner[c] = -1;
      }
      visited.clear();
    }

    std::vector<int> vertex;     ///< per vertex, that of the other piece, or -1
    std::vector<int> corner;     ///< per corner, likewise
    std::vector<char> is_image;  ///< per vertex of the other piece
    std::vector<int> visited;    ///< corners, in order
  };

  /// Walks on both pieces at once, from one corner each. Returns whether everything was matched before distances, faces
  /// or neighbors differed.
  bool match(int start, const RigidShape& other, const HalfEdges& others, int image, Matching& matching) const {
    const auto visit = [&](int one, int two) {
      if (one < 0 || two < 0) return one == two;
      if (matching.corner[one] >= 0) return matching.corner[one] == two;
      count_steps(1);
      const int v = edges_->from(one);
      const int w = others.from(two);
      if (std::abs(distances_[v] - other.distances_[w]) > tolerance) return false;
      if (std::abs(length(*edges_, one) - other.length(others, two)) > 2 * tolerance) return false;
      if (matching.vertex[v] != w && (matching.vertex[v] >= 0 || matching.is_image[w] != 0)) return false;
      matching.vertex[v] = w;
      matching.is_image[w] = 1;
      matching.corner[one] = two;
      matching.visited.push_back(one);
      return true;
    };
    if (!visit(start, image)) return false;
    for (std::size_t k = 0; k < matching.visited.size(); ++k) {
      const int one = matching.visited[k];
      const int two = matching.corner[one];
      const int twin = edges_->twin(one);
      const bool is_same = visit(edges_->next(one), others.next(two)) && visit(twin, others.twin(two)) &&
                           (twin < 0 || edges_->is_opposed(one) == others.is_opposed(two));
      if (!is_same) return false;
    }
    return matching.visited.size() == matching.corner.size() &&
           std::find(matching.vertex.begin(), matching.vertex.end(), -1) == matching.vertex.end();
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
      : parts_(parts),
        preferences_(preferences),
        any_size_(any_size),
        copies_(parts.pieces.size()),
        shapes_(parts.pieces.size()) {}

  std::vector<PieceCopy> run() {
    find_shapes();
    for (const int i : order()) {
      if (copies_[i].source < 0 && !takes_from_another(i)) copies_[i].source = i;
      const int image = parts_.mirrors[i].image;
      if (image == i || image < 0 || copies_[image].source >= 0) continue;
      copies_[image] = composed(i, parts_.mirrors[i].vertex);
      add_known(image);
    }
    return std::move(copies_);
  }

 private:
  /// Only pieces that have as many vertices, faces, corners and seams as another one can be copies.
  void find_shapes() {
    std::map<std::array<std::size_t, 4>, int> n_pieces;
    for (const Piece& piece : parts_.pieces) ++n_pieces[counts(piece)];
    for (std::size_t i = 0; i < parts_.pieces.size(); ++i) {
      const Piece& piece = parts_.pieces[i];
      if (n_pieces[counts(piece)] > 1 && has_extent(piece)) shapes_[i].emplace(piece);
    }
  }

  /// Their own mirror images first, then large ones: a small copy does not exceed the sheet where a large one fits.
  /// Sizes that differ by rounding are equal.
  std::vector<int> order() const {
    double largest = 0;
    for (const auto& shape : shapes_) largest = std::max(largest, shape ? shape->size() : 0);
    std::vector<std::array<double, 2>> keys;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const auto& shape = shapes_[i];
      keys.push_back({parts_.mirrors[i].image == static_cast<int>(i) ? 0.0 : 1.0,
                      shape ? -std::round(steps_per_octave * std::log2(shape->size() / largest)) : infinity});
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
    if (!shapes_[i]) return false;
    const RigidShape& shape = *shapes_[i];
    const ByMoment& known = known_[counts(shape.piece())];
    const double moment = shape.moments()[0];
    const auto last = known.upper_bound(moment + moment_tolerance);
    for (auto at = known.lower_bound(moment - moment_tolerance); at != last; ++at) {
      poll();
      const int source = at->second;
      RigidShape& other = *shapes_[source];
      if (((shape.moments() - other.moments()).abs() > moment_tolerance).any() ||
          (!any_size_ && std::abs(shape.size() / other.size() - 1) > moment_tolerance)) {
        continue;
      }
      const auto vertices = other.mapped_onto(shape, [&](const std::vector<int>& vertex,
                                                         const Eigen::Matrix3d& rotation) {
        return keeps_mirror(source, i, vertex) && preferences_.agree(other.piece(), shape.piece(), vertex, rotation);
      });
      if (!vertices) continue;
      copies_[i] = composed(source, *vertices);
      return true;
    }
    add_known(i);
    return false;
  }

  void add_known(int i) {
    if (shapes_[i]) known_[counts(parts_.pieces[i])].emplace(shapes_[i]->moments()[0], i);
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

  using ByMoment = std::multimap<double, int>;

  const MirroredPieces& parts_;
  const SeamPreferences& preferences_;
  bool any_size_;
  std::vector<PieceCopy> copies_;
  std::vector<std::optional<RigidShape>> shapes_;         ///< of pieces that may be copies
  std::map<std::array<std::size_t, 4>, ByMoment> known_;  ///< no copies but mirror images, per counts()
};

}  // namespace

std::vector<PieceCopy> copies_of_pieces(const MirroredPieces& parts, const SeamPreferences& preferences,
                                        bool any_size) {
  return CopySearch(parts, preferences, any_size).run();
}

}  // namespace spectral_conformal
