#include "seams/coarse_piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "concurrency/listening.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"
#include "seams/seam_graph.h"
#include "seams/shrinking_mesh.h"

namespace spectral_conformal {
namespace {

/// The fraction of the candidates, cheapest first, that a round tries: a smaller one follows the order of costs more
/// closely, a larger one needs fewer rounds.
constexpr double tried_per_round = 0.4;
/// The cost of a merge includes this fraction of the squared length of its edge: this keeps flat regions evenly meshed.
constexpr double length_weight = 0.03;
/// Limits of a merge: the least cosine of the angle by which it turns a face, and the corner_height below which it may
/// not lower a face's. Maps of folded or thin faces say nothing about the fine piece.
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

struct Merge {
  double cost;
  int vertex;
  bool operator<(const Merge& other) const { return cost != other.cost ? cost < other.cost : vertex < other.vertex; }
};

/// Newell's normal of a polygon, and the least value of (twice the area of the triangle at a corner) / (mean squared
/// edge length): 0.87 in an equilateral triangle, 1 in a square.
struct Shape {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double length = 0;  ///< of the normal
  double corner_height = 0;
};

/// Scratch memory, one per thread.
struct Fan {
  std::vector<int> neighbors;
  std::vector<int> others;
  std::vector<Shape> shapes;  ///< of the faces
  std::vector<int> after;     ///< the corners of a face after a merge
  std::vector<Merge> merges;
};

/// Finds and makes the merges.
class Coarsening {
 public:
  Coarsening(const Piece& fine, bool symmetric, const PieceMirror& mirror, const std::vector<signed char>& side,
             const std::vector<double>& preference);

  const ShrinkingMesh& mesh() const { return mesh_; }
  /// Merges the cheapest vertices until at most `n_vertices` are left. Returns how many it tried.
  int merge_round(int n_vertices);
  /// Allows all merges that do not fold faces over. Without this, rough isosurfaces kept an eighth of their vertices.
  void relax() {
    is_relaxed_ = true;
    std::fill(tried_.begin(), tried_.end(), 0);
  }
  bool is_relaxed() const { return is_relaxed_; }

 private:
  Shape shape(const Corners& corners) const;
  double cost(int v, int w) const;
  double least_cost(int v) const;
  bool surround(int v, Fan& fan) const;
  bool can_merge(int v, int w, Fan& fan) const;
  int best_neighbor(int v, Fan& fan) const;
  bool merge_with_image(int v, int w);
  void try_to_merge(int v);
  std::vector<Merge> cheapest();

  const Piece& fine_;
  bool symmetric_;
  const PieceMirror& mirror_;
  const std::vector<signed char>& side_;
  const std::vector<double>& preference_;
  ShrinkingMesh mesh_;
  std::vector<Quadric> quadrics_;
  std::vector<double> cost_;  ///< per vertex: see least_cost
  std::vector<int> target_;   ///< per vertex: the neighbor to merge it into, or -1, as of its last try
  std::vector<int> tried_;    ///< per vertex: the last round that tried it
  std::vector<int> changed_;  ///< per vertex: the last round that changed a face at it or at a neighbor
  int round_ = 0;
  bool is_relaxed_ = false;
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
      cost_(fine.vertices.size(), 0),
      target_(fine.vertices.size(), -1),
      tried_(fine.vertices.size(), 0),
      changed_(fine.vertices.size(), 0) {
  for (int f = 0; f < fine.n_faces(); ++f) {
    const Corners corners = mesh_.corners(f);
    const Shape face = shape(corners);
    const double weight = 0.5 * face.length / corners.size();
    still_working(100.0 * corners.size());
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

/// Collects the neighbors of a vertex and the shapes of its faces. Returns false if it cannot be merged at all.
bool Coarsening::surround(int v, Fan& fan) const {
  mesh_.collect_neighbors(v, fan.neighbors);
  fan.shapes.clear();
  for (const int f : mesh_.faces_of(v)) fan.shapes.push_back(shape(mesh_.corners(f)));
  return mesh_.is_simple_fan(v, fan.neighbors);
}

/// Precondition: `fan` is from surround(v).
bool Coarsening::can_merge(int v, int w, Fan& fan) const {
  const double least_cosine = is_relaxed_ ? 0 : min_turn_cosine;
  const double least_height = is_relaxed_ ? 0 : min_corner_height;
  for (std::size_t i = 0; i < fan.shapes.size(); ++i) {
    const Corners corners = mesh_.corners(mesh_.faces_of(v)[i]);
    const bool shared = corners.contains(w);
    if (shared && corners.size() <= 3) continue;
    fan.after.clear();
    for (const int c : corners) {
      if (c != v) fan.after.push_back(c);
      if (c == v && !shared) fan.after.push_back(w);
    }
    const Shape& old = fan.shapes[i];
    const Shape made = shape(Corners(fan.after));
    if (old.normal.dot(made.normal) < least_cosine * old.length * made.length) return false;
    if (made.corner_height < std::min(least_height, old.corner_height)) return false;
  }
  return mesh_.can_merge(v, w, fan.neighbors, fan.others);
}

/// The neighbor into which v can be merged at the least cost, or -1. Vertices on the mirror plane stay on it.
int Coarsening::best_neighbor(int v, Fan& fan) const {
  if (!surround(v, fan)) return -1;
  fan.merges.clear();
  for (const int w : fan.neighbors) {
    const bool crosses = symmetric_ && (side_[w] < 0 || (side_[v] == 0 && side_[w] != 0));
    const bool is_new = fan.merges.empty() || fan.merges.back().vertex != w;
    if (!crosses && is_new) fan.merges.push_back({cost(v, w), w});
  }
  std::sort(fan.merges.begin(), fan.merges.end());
  const auto best = std::find_if(fan.merges.begin(), fan.merges.end(),
                                 [&](const Merge& merge) { return can_merge(v, merge.vertex, fan); });
  return best == fan.merges.end() ? -1 : best->vertex;
}

/// Merges v into w, and the image of v into that of w. Returns false and changes nothing if the merge of v prevents
/// that of its image.
bool Coarsening::merge_with_image(int v, int w) {
  const bool has_image = symmetric_ && side_[v] != 0;
  if (has_image) {
    const ShrinkingMesh::Surroundings before = mesh_.surroundings(v);
    const int image = mirror_.vertex[v];
    const int image_into = mirror_.vertex[w];
    Fan fan;
    mesh_.merge(v, w);
    if (!surround(image, fan) || !can_merge(image, image_into, fan)) {
      mesh_.restore(v, before);
      return false;
    }
    mesh_.merge(image, image_into);
    quadrics_[image_into].planes += quadrics_[image].planes;
    quadrics_[image_into].weight += quadrics_[image].weight;
  } else {
    mesh_.merge(v, w);
  }
  quadrics_[w].planes += quadrics_[v].planes;
  quadrics_[w].weight += quadrics_[v].weight;
  return true;
}

/// Merges a vertex into its target if its image can be merged, too.
void Coarsening::try_to_merge(int v) {
  std::vector<int> around;
  for (const int center : {v, symmetric_ ? mirror_.vertex[v] : v}) {
    for (const int f : mesh_.faces_of(center)) {
      around.insert(around.end(), mesh_.corners(f).begin(), mesh_.corners(f).end());
    }
  }
  if (!merge_with_image(v, target_[v])) {
    target_[v] = -1;
    return;
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  count_steps(static_cast<double>(around.size()));
  for (const int c : around) {
    changed_[c] = round_;
    for (const int f : mesh_.faces_of(c)) {
      for (const int beside : mesh_.corners(f).beside(c)) changed_[beside] = round_;
    }
  }
}

/// The cheapest merges, sorted. Skips vertices without a target around which nothing has changed since their last try.
std::vector<Merge> Coarsening::cheapest() {
  const int n = static_cast<int>(cost_.size());
  run_blocks_in_parallel(n, element_nanoseconds, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      if (mesh_.is_left(v) && changed_[v] == round_ - 1) cost_[v] = least_cost(v);
    }
  });
  std::vector<Merge> merges;
  for_each_heard(n, [&](int v) {
    if (!mesh_.is_left(v) || !std::isfinite(cost_[v])) return;
    if (target_[v] >= 0 || changed_[v] >= tried_[v]) merges.push_back({cost_[v], v});
  });
  const auto n_cheap = static_cast<std::size_t>(tried_per_round * static_cast<double>(merges.size())) + 1;
  if (n_cheap < merges.size()) {
    std::nth_element(merges.begin(), merges.begin() + static_cast<std::ptrdiff_t>(n_cheap), merges.end());
    merges.resize(n_cheap);
  }
  call_while_listening(100.0 * static_cast<double>(merges.size()), [&] { std::sort(merges.begin(), merges.end()); });
  return merges;
}

/// Merges nothing beside a merge of the same round. Tries the next merges in parallel, one batch after the other.
int Coarsening::merge_round(int n_vertices) {
  ++round_;
  const std::vector<Merge> merges = cheapest();
  // In larger batches more tries are in vain, because merges nearby come first. With more batches, threads wait longer.
  const auto at_once = static_cast<std::size_t>(std::sqrt(static_cast<double>(merges.size()))) + 1;
  int n_tried = 0;
  for (std::size_t first = 0; first < merges.size() && mesh_.n_vertices() > n_vertices; first += at_once) {
    const std::size_t n = std::min(at_once, merges.size() - first);
    run_blocks_in_parallel(n, 5 * work_per_face, [&](std::size_t begin, std::size_t end) {
      Fan fan;
      for (std::size_t i = first + begin; i < first + end; ++i) {
        const int v = merges[i].vertex;
        if (changed_[v] == round_ || changed_[v] < tried_[v]) continue;
        target_[v] = best_neighbor(v, fan);
        tried_[v] = round_;
      }
    });
    for (std::size_t i = first; i < first + n; ++i) {
      const int v = merges[i].vertex;
      still_working(500);
      if (tried_[v] == round_) ++n_tried;
      if (target_[v] >= 0 && changed_[v] != round_ && mesh_.n_vertices() > n_vertices) try_to_merge(v);
    }
  }
  return n_tried;
}

}  // namespace

CoarsePiece coarse_piece(const Piece& fine, int index, const PieceMirror& mirror, const std::vector<signed char>& side,
                         const std::vector<double>& preference, int n_vertices, const Progress& progress) {
  const bool symmetric = mirror.image == index;
  Coarsening coarsening(fine, symmetric, mirror, side, preference);
  const ShrinkingMesh& mesh = coarsening.mesh();
  while (mesh.n_vertices() > n_vertices) {
    report(progress, 0, "seams");
    if (coarsening.merge_round(n_vertices) > 0) continue;
    if (coarsening.is_relaxed()) break;
    coarsening.relax();
  }
  CoarsePiece result;
  const std::vector<int> root = mesh.roots();
  std::vector<int> number(root.size(), -1);
  for (std::size_t v = 0; v < root.size(); ++v) {
    if (root[v] != static_cast<int>(v)) continue;
    number[v] = static_cast<int>(result.vertex.size());
    result.vertex.push_back(static_cast<int>(v));
    result.piece.vertices.push_back(fine.vertices[v]);
  }
  for (const int v : root) result.cluster.push_back(number[v]);
  result.piece.positions = fine.positions(result.vertex, Eigen::all);
  std::vector<int> face_number(fine.faces.size(), -1);
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    std::vector<int> corners;
    still_working(200);
    for (const int v : mesh.corners(static_cast<int>(f))) {
      if (corners.empty() || corners.back() != result.cluster[v]) corners.push_back(result.cluster[v]);
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) continue;
    face_number[f] = result.piece.n_faces();
    result.piece.faces.push_back(fine.faces[f]);
    result.piece.corner_vertices.insert(result.piece.corner_vertices.end(), corners.begin(), corners.end());
    result.piece.face_offsets.push_back(static_cast<int>(result.piece.corner_vertices.size()));
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
