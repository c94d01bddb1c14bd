#include "seams/coarse_piece.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/listening.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/work_counter.h"

namespace spectral_conformal {
namespace {

/// Of the merges that are possible in a round the cheapest fraction is made: fewer come nearer to the order of costs,
/// more need fewer rounds.
constexpr double merged_per_round = 0.4;
/// What a merge costs for the length of its edge, as a fraction of its square: it keeps flat regions evenly meshed.
constexpr double length_weight = 0.03;
/// The plane that keeps a boundary in its place, as a multiple of the squared length of its edge.
constexpr double boundary_weight = 1.0;
/// What a change of the preference by 1 adds to the cost, as a multiple of the squared length.
constexpr double preference_weight = 1.0;
/// The least cosine of the turn of a face, and the least height of its corners (see corner_height), if merging lowers
/// it: maps of folded or thin faces tell nothing of the fine ones.
constexpr double min_turn_cosine = 0.5;
constexpr double min_corner_height = 0.2;
/// Both are lowered by `relaxed`, at most `max_relaxations` times, when a round merges less than the fraction `stalled`
/// of the vertices: rough isosurfaces kept an eighth of theirs otherwise, and came there by one merge a round.
constexpr double stalled = 0.01;
constexpr double relaxed = 0.5;
constexpr int max_relaxations = 3;
constexpr std::size_t max_faces_around = 14;  // more would be a fan of thin triangles, whose maps tell nothing
/// A face with more corners, and a vertex with more faces, only follow what is merged beside them: to look at all of
/// it at every merge there would take quadratic time.
constexpr int most_looked_at = 256;
/// Merges of this number of vertices, or of this fraction of all, are looked for in parallel before any is made: of
/// more, more would be looked for in vain, because merges near them come first.
constexpr std::ptrdiff_t searched_at_once = 512;
constexpr int searched_fraction = 64;
constexpr double search_nanoseconds = 5000;

/// Sum of squared distances from planes, each with a weight, as x^T A x + 2 b^T x + c.
struct Quadric {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double constant = 0;
  double weight = 0;  ///< sum of the weights

  void add_plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double plane_weight) {
    const double offset = -normal.dot(point);
    matrix += plane_weight * normal * normal.transpose();
    vector += plane_weight * offset * normal;
    constant += plane_weight * offset * offset;
  }
  void add(const Quadric& other) {
    matrix += other.matrix;
    vector += other.vector;
    constant += other.constant;
    weight += other.weight;
  }
  double at(const Eigen::Vector3d& x) const { return std::max(0.0, x.dot(matrix * x) + 2 * vector.dot(x) + constant); }
};

struct Merge {
  double cost;
  int vertex;
  bool operator<(const Merge& other) const { return cost != other.cost ? cost < other.cost : vertex < other.vertex; }
};

/// What a vertex can be merged into.
struct Target {
  bool was_searched = false;
  int vertex = -1;  ///< -1 for none
};

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

/// The polygons that are left, as lists of corners.
class ShrinkingMesh {
 public:
  ShrinkingMesh(const Piece& fine, bool symmetric, const PieceMirror& mirror, const std::vector<signed char>& side,
                const std::vector<double>& preference);

  int n_vertices() const { return n_left_; }
  /// Merges the cheapest vertices, at most `most`; returns how many.
  int merge_round(int most);
  /// Allows merges that turn faces further and make them thinner.
  void relax();
  /// Per vertex: itself, or the one that it was merged into.
  const std::vector<int>& into() const { return into_; }
  /// Of a face; none where it has vanished. One with many keeps them all, also those that were merged.
  Corners corners(int face) const { return {corners_.data() + fine_.face_offsets[face], n_corners_[face]}; }

 private:
  struct Shape {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Newell's
    double length = 0;                                 ///< of the normal
    double corner_height = 0;
  };
  /// What surrounds a vertex, and scratch: each thread has its own.
  struct Fan {
    std::vector<std::pair<int, int>> neighbours;  ///< a vertex, and in how many edges of faces it occurs
    std::vector<std::pair<int, int>> others;
    std::vector<Shape> shapes;  ///< of the faces
    std::vector<int> after;     ///< the corners of a face once a vertex is merged
  };
  Shape shape(const Corners& corners) const;
  Shape shape(int face) const { return shape(corners(face)); }
  bool is_border(int v) const { return border_[static_cast<std::size_t>(v)] != 0; }
  bool is_hub(int v) const { return is_hub_[static_cast<std::size_t>(v)] != 0; }
  int n_faces_around(int v) const {
    return is_hub(v) ? faces_of_hub_[static_cast<std::size_t>(v)] : static_cast<int>(faces_of_[v].size());
  }
  int mirrored(int v) const { return mirror_.vertex[static_cast<std::size_t>(v)]; }
  void collect_neighbours(int v, Fan& fan) const;
  bool is_simple_fan(int v, Fan& fan) const;
  double cost(int v, int w) const;
  bool can_merge(int v, int w, Fan& fan) const;
  bool has_only_common_triangles(int v, int w, Fan& fan) const;
  bool leaves_hubs(int v, int w) const;
  void collect_shapes(int v, Fan& fan) const;
  bool keeps_shapes(int v, int w, Fan& fan) const;
  double least_cost(int v) const;
  void update_costs();
  int best_neighbour(int v, Fan& fan) const;
  bool is_worth_a_search(int v) const;
  std::vector<Target> search(const Merge* merges, std::ptrdiff_t n) const;
  void merge(int v, int w);
  void merge_with_image(int v, int w);
  template <class Visit>
  void visit_fans(int v, const Visit& visit) const;

  const Piece& fine_;
  bool symmetric_;
  const PieceMirror& mirror_;
  const std::vector<signed char>& side_;
  const std::vector<double>& preference_;
  std::vector<int> corners_;                ///< those of a face from its offset in the fine piece on
  std::vector<int> n_corners_;              ///< per face
  std::vector<std::vector<int>> faces_of_;  ///< per vertex, of those with few corners; none of hubs
  std::vector<char> is_hub_;                ///< per vertex: it has many faces
  std::vector<int> faces_of_hub_;           ///< per vertex: how many
  std::vector<char> border_;                ///< 1 on the boundary, 2 where a vertex has to stay
  std::vector<Quadric> quadrics_;
  std::vector<int> into_;
  std::vector<int> changed_;  ///< per vertex: the round in which a face around it was changed last
  std::vector<int> failed_;   ///< per vertex: the last round in which it could not be merged
  std::vector<double> cost_;  ///< per vertex: see least_cost
  int round_ = 0;
  double least_turn_cosine_ = min_turn_cosine;
  double least_corner_height_ = min_corner_height;
  int n_left_;
};

ShrinkingMesh::ShrinkingMesh(const Piece& fine, bool symmetric, const PieceMirror& mirror,
                             const std::vector<signed char>& side, const std::vector<double>& preference)
    : fine_(fine),
      symmetric_(symmetric),
      mirror_(mirror),
      side_(side),
      preference_(preference),
      corners_(fine.corner_vertices),
      faces_of_(fine.vertices.size()),
      is_hub_(fine.vertices.size(), 0),
      faces_of_hub_(fine.vertices.size(), 0),
      border_(fine.vertices.size(), 0),
      quadrics_(fine.vertices.size()),
      into_(fine.vertices.size()),
      changed_(fine.vertices.size(), 0),
      failed_(fine.vertices.size(), 0),
      cost_(fine.vertices.size(), 0),
      n_left_(static_cast<int>(fine.vertices.size())) {
  for (std::size_t v = 0; v < into_.size(); ++v) into_[v] = static_cast<int>(v);
  std::vector<std::array<int, 3>> sides;  // of faces: the ends, the smaller first, and the face
  for (int f = 0; f < fine.n_faces(); ++f) {
    n_corners_.push_back(fine.face_offsets[f + 1] - fine.face_offsets[f]);
    const Corners corners = this->corners(f);
    const Eigen::Vector3d normal = shape(f).normal;
    const double area = 0.5 * normal.norm();
    still_working(200.0 * corners.size());
    for (int c = 0; c < corners.size(); ++c) {
      const int v = corners[c];
      const int next = corners[c + 1 == corners.size() ? 0 : c + 1];
      if (corners.size() <= most_looked_at) faces_of_[v].push_back(f);
      sides.push_back({std::min(v, next), std::max(v, next), f});
      const double weight = area / static_cast<double>(corners.size());
      quadrics_[v].weight += weight;
      if (area > 0) quadrics_[v].add_plane(normal / (2 * area), fine.positions.row(v), weight);
    }
  }
  call_while_listening(200.0 * static_cast<double>(sides.size()), [&] { std::sort(sides.begin(), sides.end()); });
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end][0] == sides[i][0] && sides[end][1] == sides[i][1]) ++end;
    still_working(100);
    const int a = sides[i][0];
    const int b = sides[i][1];
    int f = -1;
    std::ptrdiff_t n_small = 0;
    for (std::size_t k = i; k < end; ++k) {
      if (n_corners_[sides[k][2]] > most_looked_at) continue;
      f = sides[k][2];
      ++n_small;
    }
    if (n_small == 0 || end > i + 2) {
      border_[a] = border_[b] = 2;
    } else if (n_small == 1) {
      const Eigen::Vector3d edge = fine.positions.row(b) - fine.positions.row(a);
      const Eigen::Vector3d across = edge.cross(shape(f).normal);
      for (const int v : {a, b}) {
        border_[v] = std::max(border_[v], char{1});
        if (across.norm() > 0) {
          quadrics_[v].add_plane(across.normalized(), fine.positions.row(a), boundary_weight * edge.squaredNorm());
        }
      }
    }
    i = end;
  }
  for (const auto& seam : fine.seams) border_[seam[0]] = border_[seam[1]] = 2;
  for (std::size_t v = 0; v < faces_of_.size(); ++v) {
    if (faces_of_[v].size() <= most_looked_at) continue;
    is_hub_[v] = 1;
    border_[v] = 2;
    faces_of_hub_[v] = static_cast<int>(faces_of_[v].size());
    faces_of_[v] = {};
  }
}

/// The least of (twice the area of the triangle at a corner) over the mean of the squared edges: 0.87 in an equilateral
/// triangle, 1 in a square.
ShrinkingMesh::Shape ShrinkingMesh::shape(const Corners& corners) const {
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
  const double length = result.length;
  if (!(length > 0) || !(squares > 0)) return result;
  if (n == 3) {
    result.corner_height = length / (squares / 3);
    return result;
  }
  double least = infinity;
  for (int c = 0; c < n; ++c) {
    const Eigen::Vector3d corner = point(c + 1);
    least = std::min(least, (point(c + 2) - corner).cross(point(c) - corner).dot(result.normal));
  }
  result.corner_height = least / length / (squares / static_cast<double>(n));
  return result;
}

/// The vertices joined to v by an edge, ascending.
void ShrinkingMesh::collect_neighbours(int v, Fan& fan) const {
  auto& neighbours = fan.neighbours;
  neighbours.clear();
  for (const int f : faces_of_[v]) {
    count_steps(corners(f).size());
    for (const int w : corners(f).beside(v)) neighbours.emplace_back(w, 1);
  }
  std::sort(neighbours.begin(), neighbours.end());
  std::size_t n = 0;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (n > 0 && neighbours[n - 1].first == neighbours[i].first) {
      ++neighbours[n - 1].second;
    } else {
      neighbours[n++] = neighbours[i];
    }
  }
  neighbours.resize(n);
}

/// Whether the faces around a vertex are one fan, closed inside and open on the boundary. Leaves its neighbors.
bool ShrinkingMesh::is_simple_fan(int v, Fan& fan) const {
  collect_neighbours(v, fan);
  const auto& neighbours = fan.neighbours;
  const auto open = std::count_if(neighbours.begin(), neighbours.end(), [](const auto& n) { return n.second == 1; });
  return open == (is_border(v) ? 2 : 0) &&
         std::all_of(neighbours.begin(), neighbours.end(), [](const auto& n) { return n.second <= 2; });
}

double ShrinkingMesh::cost(int v, int w) const {
  const Eigen::Vector3d from = fine_.positions.row(v);
  const Eigen::Vector3d to = fine_.positions.row(w);
  double factor = length_weight;
  if (!preference_.empty()) factor += preference_weight * std::abs(preference_[v] - preference_[w]);
  return quadrics_[v].at(to) + factor * quadrics_[v].weight * (to - from).squaredNorm();
}

/// Vertices next to both have to be those of the triangles that vanish, and must have more faces than these. Expects
/// the neighbors of v.
bool ShrinkingMesh::has_only_common_triangles(int v, int w, Fan& fan) const {
  fan.others.swap(fan.neighbours);  // those of v
  collect_neighbours(w, fan);
  fan.others.swap(fan.neighbours);  // others: those of w
  std::size_t common = 0;
  for (std::size_t i = 0, j = 0; i < fan.neighbours.size() && j < fan.others.size();) {
    if (fan.neighbours[i].first == fan.others[j].first)
      ++common, ++i, ++j;
    else if (fan.neighbours[i].first < fan.others[j].first)
      ++i;
    else
      ++j;
  }
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
    if (n_faces_around(third) < (border_[third] == 1 ? 2 : 4)) return false;
  }
  return triangles == common && faces_of_[v].size() + faces_of_[w].size() - 2 * shared <= max_faces_around;
}

/// Expects the shapes of the faces around v.
bool ShrinkingMesh::keeps_shapes(int v, int w, Fan& fan) const {
  for (std::size_t i = 0; i < faces_of_[v].size(); ++i) {
    const Corners corners = this->corners(faces_of_[v][i]);
    const bool shared = corners.contains(w);
    if (shared && corners.size() <= 3) continue;
    fan.after.clear();
    for (const int c : corners) {
      if (c != v) fan.after.push_back(c);
      if (c == v && !shared) fan.after.push_back(w);
    }
    const Shape& old = fan.shapes[i];
    const Shape made = shape(Corners(fan.after));
    if (old.normal.dot(made.normal) < least_turn_cosine_ * old.length * made.length) return false;
    if (made.corner_height < std::min(least_corner_height_, old.corner_height)) return false;
  }
  return true;
}

void ShrinkingMesh::collect_shapes(int v, Fan& fan) const {
  fan.shapes.clear();
  for (const int f : faces_of_[v]) fan.shapes.push_back(shape(f));
}

/// Whether hubs beside both still have faces enough, of which those that were merged since a search took some.
bool ShrinkingMesh::leaves_hubs(int v, int w) const {
  return std::all_of(faces_of_[v].begin(), faces_of_[v].end(), [&](int f) {
    const Corners corners = this->corners(f);
    return !corners.contains(w) ||
           std::all_of(corners.begin(), corners.end(), [&](int c) { return !is_hub(c) || faces_of_hub_[c] >= 4; });
  });
}

/// Expects the neighbors of v, and the shapes of the faces around it.
bool ShrinkingMesh::can_merge(int v, int w, Fan& fan) const {
  if (is_hub(w)) return false;
  if (is_border(v) && is_border(w)) {
    // Along the boundary only.
    const auto to =
        std::find_if(fan.neighbours.begin(), fan.neighbours.end(), [&](const auto& n) { return n.first == w; });
    if (to->second != 1) return false;
  } else if (is_border(v)) {
    return false;
  }
  return keeps_shapes(v, w, fan) && has_only_common_triangles(v, w, fan);
}

/// Of merging v into a neighbor, whether or not it can be; infinite where v has to stay.
double ShrinkingMesh::least_cost(int v) const {
  double least = infinity;
  if (border_[v] == 2 || (symmetric_ && side_[v] < 0)) return least;
  for (const int f : faces_of_[v]) {
    least = std::min(least, cost(v, corners(f).beside(v)[1]));
  }
  return least;
}

/// The one that v can be merged into at the least cost, or -1.
int ShrinkingMesh::best_neighbour(int v, Fan& fan) const {
  if (!is_simple_fan(v, fan)) return -1;
  std::vector<Merge> merges;
  for (const auto& [w, count] : fan.neighbours) {
    const bool crosses = symmetric_ && (side_[w] < 0 || (side_[v] == 0 && side_[w] != 0));
    if (!crosses && (!is_border(v) || count == 1)) merges.push_back({cost(v, w), w});
  }
  std::sort(merges.begin(), merges.end());
  collect_shapes(v, fan);
  for (const Merge& merge : merges) {
    if (can_merge(v, merge.vertex, fan)) return merge.vertex;
  }
  return -1;
}

void ShrinkingMesh::merge(int v, int w) {
  for (const int f : faces_of_[v]) {
    const Corners corners = this->corners(f);
    int* const first = corners_.data() + fine_.face_offsets[f];
    if (!corners.contains(w)) {
      std::replace(first, first + corners.size(), v, w);
      faces_of_[w].push_back(f);
      continue;
    }
    n_corners_[f] = static_cast<int>(std::remove(first, first + corners.size(), v) - first);
    if (n_corners_[f] > 2) continue;
    for (const int c : this->corners(f)) {
      if (is_hub(c)) {
        --faces_of_hub_[c];
      } else {
        faces_of_[c].erase(std::find(faces_of_[c].begin(), faces_of_[c].end(), f));
      }
    }
    n_corners_[f] = 0;
  }
  faces_of_[v].clear();
  quadrics_[w].add(quadrics_[v]);
  into_[v] = w;
  --n_left_;
}

/// Nothing is changed where the image cannot be merged any more once v is.
void ShrinkingMesh::merge_with_image(int v, int w) {
  if (!symmetric_ || side_[v] == 0) {
    merge(v, w);
    return;
  }
  std::vector<int> around{v};
  for (const int f : faces_of_[v]) around.insert(around.end(), corners(f).begin(), corners(f).end());
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  std::vector<std::vector<int>> faces_of;
  faces_of.reserve(around.size());
  std::vector<int> faces_of_hub;
  for (const int a : around) {
    faces_of.push_back(faces_of_[a]);
    faces_of_hub.push_back(faces_of_hub_[a]);
  }
  std::vector<std::pair<int, std::vector<int>>> faces;
  for (const int f : faces_of_[v]) faces.emplace_back(f, std::vector<int>(corners(f).begin(), corners(f).end()));
  const Quadric quadric = quadrics_[w];
  merge(v, w);
  const int image = mirrored(v);
  const int image_into = mirrored(w);
  Fan fan;
  collect_neighbours(image, fan);
  collect_shapes(image, fan);
  const bool joined = std::any_of(fan.neighbours.begin(), fan.neighbours.end(),
                                  [&](const auto& neighbour) { return neighbour.first == image_into; });
  if (joined && is_simple_fan(image, fan) && can_merge(image, image_into, fan)) {
    merge(image, image_into);
    return;
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    faces_of_[around[i]] = std::move(faces_of[i]);
    faces_of_hub_[around[i]] = faces_of_hub[i];
  }
  for (const auto& [f, corners] : faces) {
    std::copy(corners.begin(), corners.end(), corners_.begin() + fine_.face_offsets[f]);
    n_corners_[f] = static_cast<int>(corners.size());
  }
  quadrics_[w] = quadric;
  into_[v] = v;
  ++n_left_;
}

/// Visits the vertices around v and its image but for hubs, some of them several times.
template <class Visit>
void ShrinkingMesh::visit_fans(int v, const Visit& visit) const {
  for (const int centre : {v, symmetric_ ? mirrored(v) : v}) {
    for (const int f : faces_of_[centre]) {
      count_steps(corners(f).size());
      for (const int c : corners(f)) {
        if (!is_hub(c)) visit(c);
      }
    }
  }
}

void ShrinkingMesh::relax() {
  least_turn_cosine_ *= relaxed;
  least_corner_height_ *= relaxed;
  std::fill(failed_.begin(), failed_.end(), 0);
}

/// Of the vertices around which the last round changed something.
void ShrinkingMesh::update_costs() {
  const int n = static_cast<int>(into_.size());
  run_blocks_in_parallel(n, search_nanoseconds, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      if (into_[v] == v && changed_[v] == round_ - 1) cost_[v] = least_cost(v);
    }
  });
}

/// What failed fails again as long as nothing around it changes, and nothing is merged beside a merge of this round.
bool ShrinkingMesh::is_worth_a_search(int v) const {
  int changed = -1;
  visit_fans(v, [&](int c) { changed = std::max(changed, changed_[c]); });
  return changed != round_ && changed >= failed_[v];
}

/// For each of n merges, as things stand; only those worth a search are searched for.
std::vector<Target> ShrinkingMesh::search(const Merge* merges, std::ptrdiff_t n) const {
  std::vector<Target> targets(static_cast<std::size_t>(n));
  run_blocks_in_parallel(n, search_nanoseconds, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Fan fan;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const int v = merges[i].vertex;
      if (is_worth_a_search(v)) targets[static_cast<std::size_t>(i)] = {true, best_neighbour(v, fan)};
    }
  });
  return targets;
}

int ShrinkingMesh::merge_round(int most) {
  ++round_;
  update_costs();
  std::vector<Merge> merges;
  for (std::size_t v = 0; v < into_.size(); ++v) {
    still_working(5);
    if (into_[v] == static_cast<int>(v) && std::isfinite(cost_[v])) merges.push_back({cost_[v], static_cast<int>(v)});
  }
  const auto n_cheap = static_cast<std::ptrdiff_t>(merged_per_round * static_cast<double>(merges.size())) + 1;
  const auto last = merges.begin() + std::min(n_cheap, static_cast<std::ptrdiff_t>(merges.size()));
  std::nth_element(merges.begin(), last, merges.end());
  call_while_listening(100.0 * static_cast<double>(n_cheap), [&] { std::sort(merges.begin(), last); });
  const int before = n_left_;
  const std::ptrdiff_t at_once = std::max<std::ptrdiff_t>(searched_at_once, n_left_ / searched_fraction);
  const auto merge_cheapest = [&](auto first, auto end, int enough) {
    while (first != end && before - n_left_ < enough) {
      for (const Target target : search(&*first, std::min(at_once, end - first))) {
        if (before - n_left_ >= enough) break;
        const int v = first->vertex;
        ++first;
        still_working(200);
        // The merges before this one changed nothing that its search has looked at, or come in its way.
        if (!target.was_searched || !is_worth_a_search(v)) continue;
        if (target.vertex < 0) {
          failed_[v] = round_;
          continue;
        }
        if (!leaves_hubs(v, target.vertex)) continue;
        visit_fans(v, [&](int c) { changed_[c] = round_; });
        merge_with_image(v, target.vertex);
        still_working(2000);
      }
    }
  };
  merge_cheapest(merges.begin(), last, most);
  if (before == n_left_) {
    // Where none of the cheap ones can be merged, all others are tried until one can.
    std::sort(last, merges.end());
    merge_cheapest(last, merges.end(), 1);
  }
  return before - n_left_;
}

}  // namespace

CoarsePiece coarse_piece(const Piece& fine, int index, const PieceMirror& mirror, const std::vector<signed char>& side,
                         const std::vector<double>& preference, int n_vertices, const Progress& progress) {
  const bool symmetric = mirror.image == index;
  ShrinkingMesh mesh(fine, symmetric, mirror, side, preference);
  int relaxations = 0;
  while (mesh.n_vertices() > n_vertices) {
    report(progress, 0, "seams");
    const int merged = mesh.merge_round(mesh.n_vertices() - n_vertices);
    if (merged >= stalled * mesh.n_vertices()) continue;
    if (++relaxations > max_relaxations) break;
    mesh.relax();
  }
  CoarsePiece result;
  std::vector<int> root = mesh.into();
  for (int& v : root) {
    while (mesh.into()[v] != v) v = mesh.into()[v];
  }
  std::vector<int> number(root.size(), -1);
  for (std::size_t v = 0; v < root.size(); ++v) {
    if (root[v] != static_cast<int>(v)) continue;
    number[v] = static_cast<int>(result.vertex.size());
    result.vertex.push_back(static_cast<int>(v));
    result.piece.vertices.push_back(fine.vertices[v]);
  }
  for (const int v : root) result.cluster.push_back(number[v]);
  result.piece.positions.resize(static_cast<Eigen::Index>(result.vertex.size()), 3);
  for (std::size_t v = 0; v < result.vertex.size(); ++v) {
    result.piece.positions.row(static_cast<Eigen::Index>(v)) = fine.positions.row(result.vertex[v]);
  }
  std::vector<int> face_number(fine.faces.size(), -1);
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    std::vector<int> corners;
    still_working(200);
    for (const int v : mesh.corners(static_cast<int>(f))) {
      if (corners.empty() || corners.back() != number[root[v]]) corners.push_back(number[root[v]]);
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
