#include "seams/coarse_piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "graph/numbering.h"
#include "seams/seam_graph.h"
#include "seams/shrinking_mesh.h"

namespace spectral_conformal {
namespace {

/// The fraction of the candidates, cheapest first, that a round tries: a smaller one follows the order of costs more
/// closely, a larger one needs fewer rounds.
constexpr double tried_per_round = 0.4;
/// The cost of a merge includes this fraction of the squared length of its edge: this keeps flat regions evenly meshed.
constexpr double length_weight = 0.03;
/// Limits of a merge: the least cosine of the angle by which it turns a face, and the corner_height below which it must
/// not lower that of a face. Maps of folded or thin faces say nothing about the fine piece.
constexpr double min_turn_cosine = 0.5;
constexpr double min_corner_height = 0.2;

/// Weighted sum of squared distances from planes.
struct Quadric {
  Eigen::Matrix4d planes = Eigen::Matrix4d::Zero();
  double weight = 0;  ///< of a squared length

  void add_plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double plane_weight) {
    const Eigen::Vector4d plane(normal.x(), normal.y(), normal.z(), -normal.dot(point));
    planes += plane_weight * plane * plane.transpose();
  }
  double at(const Eigen::Vector3d& x) const {
    const Eigen::Vector4d point = x.homogeneous();
    return std::max(0.0, point.dot(planes * point));
  }
};

/// Newell's normal of a polygon, and the least value of (twice the area of the triangle at a corner) / (mean squared
/// edge length): 0.87 in an equilateral triangle, 1 in a square.
struct Shape {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double length = 0;  ///< of the normal
  double corner_height = 0;
};

/// Finds and makes the merges.
class Coarsening {
 public:
  Coarsening(const Piece& fine, bool symmetric, const PieceMirror& mirror, const std::vector<signed char>& side,
             const std::vector<double>& preference);

  const ShrinkingMesh& mesh() const { return mesh_; }
  /// Merges the cheapest vertices until at most `n_vertices` are left. Returns whether there were merges to try.
  bool merge_round(int n_vertices);
  /// Allows all merges that do not fold faces over. Without this, rough isosurfaces kept an eighth of their vertices.
  void relax() {
    is_relaxed_ = true;
    std::fill(changed_.begin(), changed_.end(), round_);
  }
  bool is_relaxed() const { return is_relaxed_; }

 private:
  using Merge = std::pair<double, int>;  ///< its cost, and a vertex

  Shape shape(const Corners& corners) const;
  double cost(int v, int w) const;
  double least_cost(int v) const;
  bool keeps_image(int v, int w) const;
  bool can_merge(int v, int w);
  int best_neighbor(int v);
  void merge(int v, int w);

  const Piece& fine_;
  bool symmetric_;
  const PieceMirror& mirror_;
  const std::vector<signed char>& side_;
  const std::vector<double>& preference_;
  ShrinkingMesh mesh_;
  std::vector<Quadric> quadrics_;
  std::vector<double> least_cost_;  ///< per vertex
  std::vector<double> cost_;        ///< per vertex: the same; infinite if its last try failed
  std::vector<int> moved_;          ///< per vertex: the last round that changed its neighbors or its quadric
  std::vector<int> changed_;        ///< per vertex: the last round that changed a face at it or at a neighbor
  int round_ = 0;
  bool is_relaxed_ = false;
  // Of the vertex being merged, and scratch:
  std::vector<int> neighbors_;
  std::vector<int> others_;
  std::vector<int> after_;
  std::vector<Merge> merges_;
};

Coarsening::Coarsening(const Piece& fine, bool symmetric, const PieceMirror& mirror,
                       const std::vector<signed char>& side, const std::vector<double>& preference)
    : fine_(fine),
      symmetric_(symmetric),
      mirror_(mirror),
      side_(side),
      preference_(preference),
      mesh_(fine),
      quadrics_(fine.vertices.size()),
      least_cost_(fine.vertices.size(), infinity),
      cost_(fine.vertices.size(), infinity),
      moved_(fine.vertices.size(), 0),
      changed_(fine.vertices.size(), 0) {
  for (int f = 0; f < fine.n_faces(); ++f) {
    const Corners corners = mesh_.corners(f);
    const Shape face = shape(corners);
    const double weight = 0.5 * face.length / corners.size();
    poll(corners.size());
    for (const int v : corners) {
      quadrics_[v].weight += weight;
      if (weight > 0) quadrics_[v].add_plane(face.normal / face.length, fine.positions.row(v), weight);
    }
  }
  // Planes perpendicular to the faces hold the boundary in place.
  for (const auto& [ends, face] : mesh_.boundary()) {
    const Eigen::Vector3d point = fine.positions.row(ends[0]);
    const Eigen::Vector3d edge = fine.positions.row(ends[1]).transpose() - point;
    const Eigen::Vector3d across = edge.cross(shape(mesh_.corners(face)).normal);
    if (!(across.norm() > 0)) continue;
    for (const int v : ends) quadrics_[v].add_plane(across.normalized(), point, edge.squaredNorm());
  }
}

Shape Coarsening::shape(const Corners& corners) const {
  Shape result;
  const int n = corners.size();
  count_steps(n);
  const auto point = [&](int c) -> Eigen::Vector3d { return fine_.positions.row(corners[c % n]); };
  const Eigen::Vector3d origin = point(0);
  double squares = 0;
  for (int c = 0; c < n; ++c) {
    result.normal += (point(c) - origin).cross(point(c + 1) - origin);
    squares += (point(c + 1) - point(c)).squaredNorm();
  }
  result.length = result.normal.norm();
  if (!(result.length > 0) || !(squares > 0)) return result;
  double least = n == 3 ? result.length * result.length : infinity;
  for (int c = 0; c < n && n > 3; ++c) {
    const Eigen::Vector3d corner = point(c + 1);
    least = std::min(least, (point(c + 2) - corner).cross(point(c) - corner).dot(result.normal));
  }
  result.corner_height = least / result.length / (squares / n);
  return result;
}

double Coarsening::cost(int v, int w) const {
  const Eigen::Vector3d to = fine_.positions.row(w);
  double factor = length_weight;
  if (!preference_.empty()) factor += std::abs(preference_[v] - preference_[w]);
  return quadrics_[v].at(to) + factor * quadrics_[v].weight * (to - fine_.positions.row(v).transpose()).squaredNorm();
}

/// The least cost of merging v into a neighbor, whether that is possible or not. Infinite if v must stay or follows its
/// image.
double Coarsening::least_cost(int v) const {
  double least = infinity;
  if (mesh_.stays(v) || (symmetric_ && side_[v] < 0)) return least;
  for (const int f : mesh_.faces_of(v)) least = std::min(least, cost(v, mesh_.corners(f).beside(v)[1]));
  return least;
}

/// Whether the merge of v into w does not affect that of their images: then either both are possible or neither is.
bool Coarsening::keeps_image(int v, int w) const {
  if (!symmetric_) return true;
  if (side_[w] != side_[v]) return false;
  if (side_[v] == 0) return true;
  if (std::binary_search(neighbors_.begin(), neighbors_.end(), mirror_.vertex[w])) return false;
  return std::all_of(mesh_.faces_of(v).begin(), mesh_.faces_of(v).end(), [&](int f) {
    const Corners corners = mesh_.corners(f);
    if (corners.contains(mirror_.vertex[v])) return false;
    // A vertex on the plane loses a face to each of the two merges.
    return corners.size() > 3 || !corners.contains(w) ||
           std::all_of(corners.begin(), corners.end(), [&](int c) { return side_[c] != 0 || mesh_.n_faces(c) > 4; });
  });
}

bool Coarsening::can_merge(int v, int w) {
  const double least_cosine = is_relaxed_ ? 0 : min_turn_cosine;
  const double least_height = is_relaxed_ ? 0 : min_corner_height;
  if (!keeps_image(v, w) || !mesh_.can_merge(v, w, neighbors_, others_)) return false;
  return std::all_of(mesh_.faces_of(v).begin(), mesh_.faces_of(v).end(), [&](int f) {
    const Corners corners = mesh_.corners(f);
    const bool shared = corners.contains(w);
    if (shared && corners.size() <= 3) return true;
    after_.clear();
    for (const int c : corners) {
      if (c != v) after_.push_back(c);
      if (c == v && !shared) after_.push_back(w);
    }
    const Shape old = shape(corners);
    const Shape made = shape(Corners(after_));
    return old.normal.dot(made.normal) >= least_cosine * old.length * made.length &&
           made.corner_height >= std::min(least_height, old.corner_height);
  });
}

/// The neighbor into which v can be merged at the least cost, or -1.
int Coarsening::best_neighbor(int v) {
  mesh_.collect_neighbors(v, neighbors_);
  if (!mesh_.is_simple_fan(v, neighbors_)) return -1;
  merges_.clear();
  for (const int w : neighbors_) {
    if (merges_.empty() || merges_.back().second != w) merges_.emplace_back(cost(v, w), w);
  }
  std::sort(merges_.begin(), merges_.end());
  const auto best =
      std::find_if(merges_.begin(), merges_.end(), [&](const Merge& merge) { return can_merge(v, merge.second); });
  return best == merges_.end() ? -1 : best->second;
}

void Coarsening::merge(int v, int w) {
  mesh_.merge(v, w);
  quadrics_[w].planes += quadrics_[v].planes;
  quadrics_[w].weight += quadrics_[v].weight;
}

/// Merges nothing beside a merge of the same round, so that all clusters grow alike.
bool Coarsening::merge_round(int n_vertices) {
  std::vector<Merge> merges;
  for_each_polled(static_cast<int>(cost_.size()), [&](int v) {
    if (!mesh_.is_left(v)) return;
    if (moved_[v] == round_) least_cost_[v] = least_cost(v);
    if (changed_[v] == round_) cost_[v] = least_cost_[v];
    if (std::isfinite(cost_[v])) merges.emplace_back(cost_[v], v);
  });
  ++round_;
  const auto n_tried = static_cast<std::ptrdiff_t>(tried_per_round * static_cast<double>(merges.size()));
  std::nth_element(merges.begin(), merges.begin() + n_tried, merges.end());
  std::sort(merges.begin(), merges.begin() + n_tried);
  for (std::ptrdiff_t i = 0; i <= n_tried && !merges.empty() && mesh_.n_vertices() > n_vertices; ++i) {
    const int v = merges[i].second;
    if (changed_[v] == round_) continue;
    poll();
    const int w = best_neighbor(v);
    if (w < 0) {
      cost_[v] = infinity;
      continue;
    }
    std::vector<int> around = neighbors_;
    merge(v, w);
    if (symmetric_ && side_[v] != 0) {
      for (const int beside : neighbors_) around.push_back(mirror_.vertex[beside]);
      merge(mirror_.vertex[v], mirror_.vertex[w]);
    }
    for (const int c : around) {
      moved_[c] = changed_[c] = round_;
      for (const int f : mesh_.faces_of(c)) {
        for (const int beside : mesh_.corners(f).beside(c)) changed_[beside] = round_;
      }
    }
  }
  return !merges.empty();
}

}  // namespace

CoarsePiece coarse_piece(const Piece& fine, int index, const PieceMirror& mirror, const std::vector<signed char>& side,
                         const std::vector<double>& preference, int n_vertices, const Progress& progress) {
  const bool symmetric = mirror.image == index;
  Coarsening coarsening(fine, symmetric, mirror, side, preference);
  const ShrinkingMesh& mesh = coarsening.mesh();
  while (mesh.n_vertices() > n_vertices) {
    report(progress, 0, "seams");
    if (coarsening.merge_round(n_vertices)) continue;
    if (coarsening.is_relaxed()) break;
    coarsening.relax();
  }
  CoarsePiece result;
  const std::vector<int> root = mesh.roots();
  std::vector<int> number(root.size(), -1);
  for (const int v : root) number[v] = 0;
  result.vertex = number_marked(number);
  for (const int v : result.vertex) result.piece.vertices.push_back(fine.vertices[v]);
  for (const int v : root) result.cluster.push_back(number[v]);
  result.piece.positions = fine.positions(result.vertex, Eigen::all);
  std::vector<int> face_number(fine.faces.size(), -1);
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    std::vector<int> corners;
    poll();
    for (const int v : mesh.corners(static_cast<int>(f))) {
      if (corners.empty() || corners.back() != result.cluster[v]) corners.push_back(result.cluster[v]);
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) continue;
    face_number[f] = result.piece.n_faces();
    result.piece.faces.push_back(fine.faces[f]);
    result.piece.corner_vertices.insert(result.piece.corner_vertices.end(), corners.begin(), corners.end());
    result.piece.end_face();
  }
  for (const auto& seam : fine.seams) result.piece.seams.push_back({number[seam[0]], number[seam[1]]});
  result.mirror.image = symmetric ? index : -1;
  if (!symmetric) return result;
  for (const int v : result.vertex) result.mirror.vertex.push_back(number[mirror.vertex[v]]);
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    if (face_number[f] >= 0) result.mirror.face.push_back(face_number[mirror.face[f]]);
  }
  return result;
}

}  // namespace spectral_conformal
