#include "seams/rigid_unfolding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/polygon_normal.h"
#include "geometry/polygon_triangulation.h"
#include "seams/triangle_forest.h"
#include "spectral_conformal/plane_motion.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {
namespace {

/// Least cosine between the normals of a facet and of its first face: modeled planes are this flat.
const double facet_cosine = std::cos(1 * pi / 180);
/// Largest gap between the aligned ends of a hinge, as a fraction of its length: the tolerance of facets adds up around
/// a vertex. Also the largest overlap of triangles, as a fraction of the smaller of their least heights.
constexpr double closure = 0.02;
/// Shortest hinge, as a fraction of the narrower net's width along it: a side of a hexagonal cap, half its width, may
/// hold it, and so may that of an octagonal one, 0.41, but not that of a round one.
constexpr double min_hinge = 0.4;
/// Widths are measured within this multiple of the hinge's length from it: more than the height of a tooth, or a gear
/// would dangle from its tip, but so little that the end of a curved strip is as wide as the strip.
constexpr double hinge_depth = 3;
/// A piece with more is not a model of flat parts; at this number, joining takes as long as the search for seams.
constexpr std::size_t max_facets = 8000;

/// Facets joined by hinges, in a plane of their own.
struct Net {
  std::vector<int> faces;
  TriangleForest triangles;
  double area = 0;
};

class Unfolder {
 public:
  Unfolder(const Piece& piece, const SeamGraph& graph) : piece_(piece), graph_(graph) {}

  /// Lays every facet into a plane of its own. Returns false if they are too many to join.
  bool begin() {
    find_corners();
    lay_facets();
    return nets_.size() <= max_facets;
  }

  void join_all() {
    std::set<std::pair<int, int>> pairs;
    for (const auto& edge : graph_.edges()) {
      if (edge.cut) continue;
      const std::pair<int, int> nets = std::minmax({net_of(edge.faces[0]), net_of(edge.faces[1])});
      if (nets.first != nets.second) pairs.insert(nets);
    }
    for (const auto& [a, b] : pairs) propose(a, b);
    while (!queue_.empty()) {
      const Joint joint = queue_.top();
      queue_.pop();
      if (joint.version == versions_[key(joint.nets[0], joint.nets[1])]) join(joint);
    }
  }

  std::vector<int> seams() const {
    std::vector<int> result;
    for (int e = 0; e < static_cast<int>(is_hinge_.size()); ++e) {
      if (!edge_at(e).cut && !is_hinge_[e]) result.push_back(e);
    }
    return result;
  }

 private:
  /// Two nets that common edges can join as hinges.
  struct Joint {
    float price;  ///< of the edges; in single precision, so rounding errors do not decide
    int depth;    ///< sum for the two facets, in hinges from the facets where their nets began
    double area;  ///< of the larger net
    std::array<int, 2> nets;
    int edge;                 ///< the one to align
    std::vector<int> hinges;  ///< all edges that this aligns
    unsigned version;

    /// Whether it is joined later: cheaper, or deeper, so that a net grows around one facet and a box becomes a cross.
    bool operator<(const Joint& other) const {
      return std::make_tuple(price, -depth, area, other.nets, other.edge) <
             std::make_tuple(other.price, -other.depth, other.area, nets, edge);
    }
  };

  static std::uint64_t key(int a, int b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
  }
  int net_of(int face) const { return net_of_face_[face]; }
  const SeamGraph::Edge& edge_at(int e) const { return graph_.edges()[e]; }

  /// Finds the corners at the ends of every edge, in both of its faces.
  void find_corners() {
    corners_.assign(graph_.edges().size(), {{{-1, -1}, {-1, -1}}});
    is_hinge_.assign(graph_.edges().size(), false);
    for_each_side(piece_.view(), [&](int one, int two, int face) {
      const int a = vertex(one);
      const int b = vertex(two);
      if (a == b) return;
      const int e = graph_.find_edge(a, b);
      if (e < 0) return;
      const SeamGraph::Edge& edge = edge_at(e);
      auto& ends = corners_[e][edge.faces[0] == face ? 0 : 1];
      ends = edge.vertices[0] == a ? std::array<int, 2>{one, two} : std::array<int, 2>{two, one};
      // With the same face on both sides, as on a bridge to a hole, the edge is a hinge.
      if (edge.faces[0] == edge.faces[1]) is_hinge_[e] = true;
    });
  }
  int vertex(int corner) const { return piece_.corner_vertices[corner]; }

  void lay_facets() {
    const int n_faces = piece_.n_faces();
    std::vector<Eigen::Vector3d> normals;
    for (int face = 0; face < n_faces; ++face) {
      poll();
      const Positions corners = piece_.corners(face);
      normals.push_back(corners.rows() < 3 ? Eigen::Vector3d::Zero()
                                           : Eigen::Vector3d(polygon_normal(corners, corners.row(0).transpose())));
      normals.back().normalize();
    }
    z_.assign(piece_.corner_vertices.size(), 0);
    net_of_face_.assign(static_cast<std::size_t>(n_faces), -1);
    for (int seed = 0; seed < n_faces; ++seed) {
      if (net_of(seed) >= 0) continue;
      if (nets_.size() > max_facets) return;
      const int facet = static_cast<int>(nets_.size());
      std::vector<int> faces{seed};
      net_of_face_[seed] = facet;
      for (std::size_t next = 0; next < faces.size(); ++next) {
        for (const auto& [e, to] : graph_.dual().arcs(faces[next])) {
          if (edge_at(e).cut) continue;
          const double cosine = normals[seed].dot(normals[to]);
          if (net_of(to) < 0 && cosine >= facet_cosine) {
            net_of_face_[to] = facet;
            faces.push_back(to);
          }
          if (net_of(to) == facet) is_hinge_[e] = true;
        }
      }
      lay(std::move(faces), normals[seed]);
    }
    facet_of_face_ = net_of_face_;
    depth_.assign(nets_.size(), 0);
  }

  /// Projects a facet onto its plane.
  void lay(std::vector<int>&& faces, const Eigen::Vector3d& normal) {
    // Any directions do for a face without area, which has no plane.
    const Eigen::Vector3d x = normal.isZero() ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(normal.unitOrthogonal());
    const Eigen::Vector3d y = normal.isZero() ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(normal.cross(x));
    const Eigen::RowVector3d origin = piece_.corners(faces.front()).row(0);
    Net result;
    std::vector<PlaneTriangle> triangles;
    for (const int face : faces) {
      poll();
      const Positions corners = piece_.corners(face);
      const int first = piece_.face_offsets[face];
      for (int i = 0; i < corners.rows(); ++i) {
        const Eigen::Vector3d from_origin = (corners.row(i) - origin).transpose();
        z_[first + i] = {from_origin.dot(x), from_origin.dot(y)};
      }
      if (corners.rows() < 3) continue;
      PolygonTriangulation split;
      triangulate_polygon(corners, split);
      // For a quad with both splits, only the first.
      const std::size_t n = std::min(split.triangles.size(), static_cast<std::size_t>(corners.rows() - 2));
      for (std::size_t t = 0; t < n; ++t) {
        const auto& [a, b, c] = split.triangles[t];
        triangles.emplace_back(std::array<Complex, 3>{z_[first + a], z_[first + b], z_[first + c]});
        result.area += 0.5 * triangles.back().height[0] * std::abs(z_[first + b] - z_[first + a]);
      }
    }
    result.faces = std::move(faces);
    result.triangles.add(std::move(triangles));
    nets_.push_back(std::move(result));
  }

  /// The positions of an edge's ends in a net.
  std::array<Complex, 2> ends(int edge, int in_net) const {
    const auto& faces = edge_at(edge).faces;
    const auto& corners = corners_[edge][net_of(faces[0]) == in_net ? 0 : 1];
    return {z_[corners[0]], z_[corners[1]]};
  }

  /// The motion of the second net that aligns the edge with its copy in the first, centers together.
  PlaneMotion onto(int edge, int first, int second) const {
    const auto [p, q] = ends(edge, first);
    const auto [r, s] = ends(edge, second);
    const Complex turn = (q - p) / (s - r);
    const Complex rotation = turn / std::abs(turn);
    return {rotation, false, 0.5 * (p + q) - rotation * (0.5 * (r + s))};
  }

  std::vector<int> shared_edges(int a, int b) const {
    if (nets_[b].faces.size() <= nets_[a].faces.size()) std::swap(a, b);
    std::vector<int> result;
    for (const int face : nets_[a].faces) {
      for (const auto& [e, to] : graph_.dual().arcs(face)) {
        poll();
        if (!edge_at(e).cut && net_of(to) == b) result.push_back(e);
      }
    }
    std::sort(result.begin(), result.end(), [&](int x, int y) {
      return edge_at(x).length != edge_at(y).length ? edge_at(x).length > edge_at(y).length : x < y;
    });
    return result;
  }

  /// Whether a motion of the second net aligns a common edge.
  bool is_aligned(int edge, int first, int second, const PlaneMotion& motion) const {
    const double tolerance = std::pow(closure * edge_at(edge).length, 2);
    const auto [p, q] = ends(edge, first);
    const auto [r, s] = ends(edge, second);
    return std::norm(motion(r) - p) <= tolerance && std::norm(motion(s) - q) <= tolerance;
  }

  /// Common edges of two nets, by the angle of the motion that aligns each. It aligns no others whose angles differ by
  /// more than the window; to test all edges of a round cap for each of them would take quadratic time.
  struct Turns {
    std::vector<std::pair<double, int>> ranked;  ///< angle, on two rounds of the circle, and index of the edge
    double window = 0;

    std::vector<int> near(double angle) const {
      const double begin = angle - window + (angle - window < -pi ? 2 * pi : 0);
      std::vector<int> indices;
      for (auto at = std::lower_bound(ranked.begin(), ranked.end(), std::make_pair(begin, 0));
           at != ranked.end() && at->first <= begin + 2 * window; ++at)
        indices.push_back(at->second);
      std::sort(indices.begin(), indices.end());
      return indices;
    }
  };
  Turns turns(const std::vector<int>& edges, int first, int second) const {
    Turns result;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const auto [p, q] = ends(edges[i], first);
      const auto [r, s] = ends(edges[i], second);
      const double angle = std::arg((q - p) * std::conj(s - r));
      for (const double round : {0.0, 2 * pi}) result.ranked.emplace_back(angle + round, static_cast<int>(i));
      // Its ends move by so much at most.
      const double gap = 2 * closure * edge_at(edges[i]).length;
      result.window = std::max(result.window, gap < std::abs(q - p) ? std::asin(gap / std::abs(q - p)) : pi);
    }
    std::sort(result.ranked.begin(), result.ranked.end());
    return result;
  }

  /// Queues every way to join two nets.
  void propose(int a, int b) {
    const unsigned version = ++versions_[key(a, b)];
    const std::vector<int> shared = shared_edges(a, b);
    const Turns angles = turns(shared, a, b);
    std::set<int> joined_before;
    for (const int e : shared) {
      const auto [r, s] = ends(e, b);
      if (joined_before.count(e) > 0 || !(edge_at(e).length > 0) || r == s) continue;
      const PlaneMotion motion = onto(e, a, b);
      std::vector<int> joined;
      for (const int i : angles.near(std::arg(motion.factor))) {
        if (is_aligned(shared[i], a, b, motion)) joined.push_back(shared[i]);
      }
      joined_before.insert(joined.begin(), joined.end());
      if (joined.empty()) continue;
      double price = 0;
      for (const int h : joined) price += edge_at(h).cost;
      const auto& faces = edge_at(e).faces;
      const double area = std::max(nets_[a].area, nets_[b].area);
      const int depths = depth(faces[0]) + depth(faces[1]);
      queue_.push({static_cast<float>(price), depths, area, {a, b}, e, std::move(joined), version});
    }
  }
  int& depth(int face) { return depth_[facet_of_face_[face]]; }

  void join(const Joint& joint) {
    auto [fixed, moved] = joint.nets;
    if (nets_[fixed].faces.size() < nets_[moved].faces.size()) std::swap(fixed, moved);
    const PlaneMotion motion = onto(joint.edge, fixed, moved);
    if (dangles(joint.edge, joint.hinges, fixed, moved)) return;
    std::vector<PlaneTriangle> triangles = nets_[moved].triangles.moved(motion);
    poll(triangles.size());
    for (const PlaneTriangle& t : triangles) {
      if (nets_[fixed].triangles.overlaps(t, closure)) return;
    }
    for (const int e : joint.hinges) is_hinge_[e] = true;
    const auto& faces = edge_at(joint.edge).faces;
    const int root = nets_[fixed].area >= nets_[moved].area ? fixed : moved;
    const int near = net_of(faces[0]) == root ? faces[0] : faces[1];
    const int far = near == faces[0] ? faces[1] : faces[0];
    depth(far) = std::max(depth(far), depth(near) + 1);

    std::set<int> beside;
    for (const int face : nets_[moved].faces) {
      for (const auto& [e, to] : graph_.dual().arcs(face)) {
        const int other = net_of(to);
        if (!edge_at(e).cut && other != fixed && other != moved) beside.insert(other);
      }
    }
    for (const int face : nets_[moved].faces) {
      net_of_face_[face] = fixed;
      for (int c = piece_.face_offsets[face]; c < piece_.face_offsets[face + 1]; ++c) z_[c] = motion(z_[c]);
    }
    ++versions_[key(fixed, moved)];
    for (const int other : beside) ++versions_[key(moved, other)];
    Net& whole = nets_[fixed];
    Net& part = nets_[moved];
    whole.faces.insert(whole.faces.end(), part.faces.begin(), part.faces.end());
    whole.triangles.add(std::move(triangles));
    whole.area += part.area;
    part = {};
    for (const int other : beside) propose(fixed, other);
  }

  /// Whether the hinges, as one segment about the middle of an edge, are too short for both nets.
  bool dangles(int edge, const std::vector<int>& joined, int a, int b) {
    double hinge = 0;
    for (const int e : joined) hinge += edge_at(e).length;
    // The smaller net first: it is usually the narrow one, and then the other need not be measured.
    if (nets_[b].faces.size() < nets_[a].faces.size()) std::swap(a, b);
    for (const int i : {a, b}) {
      const auto [p, q] = ends(edge, i);
      const Complex half = 0.5 * hinge * (q - p) / std::abs(q - p);
      const Complex middle = 0.5 * (p + q);
      if (!nets_[i].triangles.is_wider_along(middle - half, middle + half, hinge_depth * hinge, hinge / min_hinge))
        return false;
    }
    return true;
  }

  const Piece& piece_;
  const SeamGraph& graph_;
  std::vector<std::array<std::array<int, 2>, 2>> corners_;  ///< per edge and face: of its first and second vertex
  std::vector<Complex> z_;                                  ///< per corner, in the plane of its net
  std::vector<int> net_of_face_;
  std::vector<int> facet_of_face_;
  std::vector<int> depth_;  ///< per facet
  std::vector<Net> nets_;
  std::vector<bool> is_hinge_;  ///< per edge
  std::priority_queue<Joint> queue_;
  std::unordered_map<std::uint64_t, unsigned> versions_;  ///< per pair of nets: joints of earlier versions are void
};

}  // namespace

std::vector<int> rigid_unfolding_seams(const Piece& piece, const SeamGraph& graph) {
  Unfolder unfolder(piece, graph);
  if (!unfolder.begin()) return {};
  unfolder.join_all();
  return unfolder.seams();
}

}  // namespace spectral_conformal
