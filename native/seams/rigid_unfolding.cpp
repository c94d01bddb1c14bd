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

#include "concurrency/listening.h"
#include "geometry/box_tree.h"
#include "geometry/plane_triangle.h"
#include "geometry/polygon_normal.h"
#include "geometry/polygon_triangulation.h"

namespace spectral_conformal {
namespace {

/// Normals of one facet, to that of its first face: what modelling leaves of a plane.
const double facet_cosine = std::cos(1 * M_PI / 180);
/// Ends of a hinge that come together may be apart by this fraction of its length, which the flatness of facets lets
/// add up around a vertex.
constexpr double closure = 0.02;
/// The least hinge, as a fraction of the width that the narrower net has along it: the sides of a hexagonal cap, half
/// of its width, may hold it, and those of an octagonal one, 0.41; of a round one not.
constexpr double min_hinge = 0.4;
/// Widths are those within this multiple of the hinge's length from it: more than a tooth is high, on whose tip a gear
/// would dangle, and little enough that the ends of a curved strip are as wide as the strip.
constexpr double hinge_depth = 3;
/// Overlaps that are no deeper than this fraction of a triangle's least height come from the tolerance of `closure`.
constexpr double contact_tolerance = 0.02;
/// More are no model of flat parts; the search for seams takes as long.
constexpr std::size_t max_facets = 8000;
/// Prices of hinges count as equal within this fraction of the root of the area, so that rounding does not choose.
constexpr double price_step = 1e-6;

constexpr double joining_nanoseconds = 200;  // about what a triangle takes to be moved and tested

/// A rigid motion of the plane: z -> turn z + shift.
struct Motion {
  Complex turn = 1;
  Complex shift = 0;
  Complex operator()(Complex z) const { return turn * z + shift; }
};

/// What two lines leave of a triangle: each adds a corner, and, should rounding have it cross every side, as many as
/// there are.
class ClippedTriangle {
 public:
  void push_back(Complex corner) { corners_[size_++] = corner; }
  const Complex* begin() const { return corners_.data(); }
  const Complex* end() const { return corners_.data() + size_; }

 private:
  std::array<Complex, 12> corners_;
  std::size_t size_ = 0;
};

/// Triangles in the plane that others can be tested against, while more come in: trees of sizes that fall by half at
/// least, so that each triangle is placed into a new tree a logarithmic number of times.
class TriangleForest {
 public:
  void add(std::vector<PlaneTriangle>&& triangles) {
    while (!groves_.empty() && groves_.back().triangles.size() <= 2 * triangles.size()) {
      std::vector<PlaneTriangle>& smaller = groves_.back().triangles;
      triangles.insert(triangles.end(), smaller.begin(), smaller.end());
      groves_.pop_back();
    }
    std::vector<PlaneBox> boxes;
    boxes.reserve(triangles.size());
    for (const PlaneTriangle& t : triangles) boxes.push_back(box_of(t));
    groves_.push_back({std::move(triangles), BoxTree(boxes)});
  }
  bool overlaps(const PlaneTriangle& triangle) const {
    bool found = false;
    for (const Grove& grove : groves_) {
      grove.tree.for_each_meeting(box_of(triangle), [&](int i) {
        found = are_overlapping(grove.triangles[static_cast<std::size_t>(i)], triangle);
        return !found;
      });
      if (found) return true;
    }
    return false;
  }
  /// Whether the triangles reach farther along a segment than `widest`, at least its length, within `hinge_depth` times
  /// its length from it.
  bool is_wider_along(Complex from, Complex to, double widest) const {
    const double length = std::abs(to - from);
    const Complex direction = (to - from) / length;
    const Complex middle = 0.5 * (from + to);
    double low = 0.5 * -length;
    double high = 0.5 * length;
    const double depth = hinge_depth * length;
    const Complex across = direction * Complex(0, depth);
    const Complex along = direction * widest;
    const PlaneBox box = PlaneBox::of(
        {middle + along + across, middle + along - across, middle - along + across, middle - along - across});
    for (const Grove& grove : groves_) {
      grove.tree.for_each_meeting(box, [&](int i) {
        ClippedTriangle polygon;
        for (const Complex corner : grove.triangles[static_cast<std::size_t>(i)].corners) {
          polygon.push_back((corner - middle) * std::conj(direction));
        }
        polygon = clipped(clipped(polygon, 1, depth), -1, depth);
        const auto [first, last] = std::minmax_element(polygon.begin(), polygon.end(),
                                                       [](Complex p, Complex q) { return p.real() < q.real(); });
        if (first == polygon.end() || first->real() > widest || last->real() < -widest) return true;
        low = std::min(low, std::max(first->real(), -widest));
        high = std::max(high, std::min(last->real(), widest));
        return high - low <= widest;
      });
      if (high - low > widest) return true;
    }
    return false;
  }
  std::vector<PlaneTriangle> moved(const Motion& motion) const {
    std::vector<PlaneTriangle> result;
    for (const Grove& grove : groves_) {
      for (const PlaneTriangle& t : grove.triangles) {
        result.emplace_back(std::array<Complex, 3>{motion(t.corners[0]), motion(t.corners[1]), motion(t.corners[2])});
      }
    }
    return result;
  }

 private:
  struct Grove {
    std::vector<PlaneTriangle> triangles;
    BoxTree tree;
  };

  /// The part of a polygon where sign * y is at most `limit` (Sutherland and Hodgman 1974).
  static ClippedTriangle clipped(const ClippedTriangle& polygon, double sign, double limit) {
    ClippedTriangle result;
    for (const Complex* at = polygon.begin(); at != polygon.end(); ++at) {
      const Complex p = *at;
      const Complex q = at + 1 == polygon.end() ? *polygon.begin() : at[1];
      const double over_p = sign * p.imag() - limit;
      const double over_q = sign * q.imag() - limit;
      if (over_p <= 0) result.push_back(p);
      if ((over_p < 0 && over_q > 0) || (over_p > 0 && over_q < 0))
        result.push_back(p + (q - p) * (over_p / (over_p - over_q)));
    }
    return result;
  }
  static PlaneBox box_of(const PlaneTriangle& t) { return PlaneBox::of({t.corners[0], t.corners[1], t.corners[2]}); }
  static double least_height(const PlaneTriangle& t) {
    return std::max(*std::min_element(t.height.begin(), t.height.end()), 0.0);
  }
  static bool are_overlapping(const PlaneTriangle& a, const PlaneTriangle& b) {
    const double tolerance = contact_tolerance * std::min(least_height(a), least_height(b));
    return !separated_by_side(a, b, tolerance) && !separated_by_side(b, a, tolerance);
  }

  std::vector<Grove> groves_;
};

/// Facets that were joined by hinges, in a plane of their own.
struct Net {
  std::vector<int> faces;
  TriangleForest triangles;
  double area = 0;
};

class Unfolder {
 public:
  Unfolder(const Piece& piece, const SeamGraph& graph) : piece_(piece), graph_(graph) {
    find_corners();
    lay_facets();
  }

  bool has_few_facets() const { return nets_.size() <= max_facets; }

  void join_all() {
    std::set<std::pair<int, int>> pairs;
    for (const auto& edge : graph_.edges()) {
      if (!edge.cut && net_of(edge.faces[0]) != net_of(edge.faces[1])) {
        pairs.insert(std::minmax(net_of(edge.faces[0]), net_of(edge.faces[1])));
      }
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
    for (std::size_t e = 0; e < graph_.edges().size(); ++e) {
      if (!graph_.edges()[e].cut && !is_hinge_[e]) result.push_back(static_cast<int>(e));
    }
    return result;
  }

 private:
  /// Two nets that edges can be hinges of.
  struct Joint {
    std::int64_t price;  ///< of the edges, in steps
    int depth;           ///< of the two facets, counted from the facets that their nets began with
    double area;         ///< of the larger net
    std::array<int, 2> nets;
    int edge;  ///< the one by which they are brought together
    unsigned version;

    /// The one to be joined later: cheaper, or deeper, so that a net grows around one facet, and a box becomes a cross.
    bool operator<(const Joint& other) const {
      return std::make_tuple(price, -depth, area, other.nets, other.edge) <
             std::make_tuple(other.price, -other.depth, other.area, nets, edge);
    }
  };

  static std::uint64_t key(int a, int b) {
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
  }
  int net_of(int face) const { return net_of_face_[static_cast<std::size_t>(face)]; }
  Net& net(int i) { return nets_[static_cast<std::size_t>(i)]; }

  /// Of every edge between two faces, the corners of its ends in both.
  void find_corners() {
    corners_.assign(graph_.edges().size(), {{{-1, -1}, {-1, -1}}});
    is_hinge_.assign(graph_.edges().size(), false);
    for (int face = 0; face < piece_.n_faces(); ++face) {
      const int first = piece_.face_offsets[static_cast<std::size_t>(face)];
      const int size = piece_.face_offsets[static_cast<std::size_t>(face) + 1] - first;
      for (int i = 0; i < size; ++i) {
        const int one = first + i;
        const int two = first + (i + 1) % size;
        const int a = vertex(one);
        const int b = vertex(two);
        if (a == b) continue;
        const int e = graph_.find_edge(a, b);
        if (e < 0) continue;
        const auto& edge = graph_.edges()[static_cast<std::size_t>(e)];
        auto& ends = corners_[static_cast<std::size_t>(e)][edge.faces[0] == face ? 0 : 1];
        ends = edge.vertices[0] == a ? std::array<int, 2>{one, two} : std::array<int, 2>{two, one};
        // A face on both sides of an edge, as along a bridge to a hole, is in one plane with itself.
        if (edge.faces[0] == edge.faces[1]) is_hinge_[static_cast<std::size_t>(e)] = true;
      }
    }
  }
  Complex& at_corner(int corner) { return z_[static_cast<std::size_t>(corner)]; }
  int vertex(int corner) const { return piece_.corner_vertices[static_cast<std::size_t>(corner)]; }

  void lay_facets() {
    const int n_faces = piece_.n_faces();
    std::vector<Eigen::Vector3d> normals;
    for (int face = 0; face < n_faces; ++face) {
      still_working(joining_nanoseconds);
      const Positions corners = piece_.corners(face);
      normals.push_back(corners.rows() < 3 ? Eigen::Vector3d::Zero()
                                           : Eigen::Vector3d(polygon_normal(corners, corners.row(0).transpose())));
      area_ += 0.5 * normals.back().norm();
      normals.back().normalize();
    }
    z_.assign(piece_.corner_vertices.size(), 0);
    net_of_face_.assign(static_cast<std::size_t>(n_faces), -1);
    for (int seed = 0; seed < n_faces; ++seed) {
      if (net_of(seed) >= 0) continue;
      if (nets_.size() > max_facets) return;
      const int facet = static_cast<int>(nets_.size());
      std::vector<int> faces{seed};
      net_of_face_[static_cast<std::size_t>(seed)] = facet;
      for (std::size_t next = 0; next < faces.size(); ++next) {
        for (const auto& [e, to] : graph_.dual().arcs(faces[next])) {
          if (graph_.edges()[static_cast<std::size_t>(e)].cut) continue;
          const double cosine = normals[static_cast<std::size_t>(seed)].dot(normals[static_cast<std::size_t>(to)]);
          if (net_of(to) < 0 && cosine >= facet_cosine) {
            net_of_face_[static_cast<std::size_t>(to)] = facet;
            faces.push_back(to);
          }
          if (net_of(to) == facet) is_hinge_[static_cast<std::size_t>(e)] = true;
        }
      }
      lay(std::move(faces), normals[static_cast<std::size_t>(seed)]);
    }
    facet_of_face_ = net_of_face_;
    depth_.assign(nets_.size(), 0);
  }

  /// Projects a facet into its plane.
  void lay(std::vector<int>&& faces, const Eigen::Vector3d& normal) {
    // Any directions where a face without area has no plane.
    const Eigen::Vector3d x = normal.isZero() ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(normal.unitOrthogonal());
    const Eigen::Vector3d y = normal.isZero() ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(normal.cross(x));
    const Eigen::RowVector3d origin = piece_.corners(faces.front()).row(0);
    Net result;
    std::vector<PlaneTriangle> triangles;
    for (const int face : faces) {
      still_working(joining_nanoseconds);
      const Positions corners = piece_.corners(face);
      const int first = piece_.face_offsets[static_cast<std::size_t>(face)];
      for (int i = 0; i < corners.rows(); ++i) {
        const Eigen::Vector3d from_origin = (corners.row(i) - origin).transpose();
        const Complex at(from_origin.dot(x), from_origin.dot(y));
        at_corner(first + i) = at;
      }
      if (corners.rows() < 3) continue;
      PolygonTriangulation split;
      triangulate_polygon(corners, split);
      // Of a quad with both splits the first.
      const std::size_t n = std::min(split.triangles.size(), static_cast<std::size_t>(corners.rows() - 2));
      for (std::size_t t = 0; t < n; ++t) {
        const auto& [a, b, c] = split.triangles[t];
        triangles.emplace_back(
            std::array<Complex, 3>{at_corner(first + a), at_corner(first + b), at_corner(first + c)});
        result.area +=
            0.5 * triangles.back().height[0] * std::abs(triangles.back().corners[1] - triangles.back().corners[0]);
      }
    }
    result.faces = std::move(faces);
    result.triangles.add(std::move(triangles));
    nets_.push_back(std::move(result));
  }

  /// The ends of an edge as they lie in a net.
  std::array<Complex, 2> ends(int edge, int in_net) const {
    const auto& faces = graph_.edges()[static_cast<std::size_t>(edge)].faces;
    const auto& corners = corners_[static_cast<std::size_t>(edge)][net_of(faces[0]) == in_net ? 0 : 1];
    return {z_[static_cast<std::size_t>(corners[0])], z_[static_cast<std::size_t>(corners[1])]};
  }

  /// What moves the second net so that the edge's ends come together with those in the first.
  Motion onto(int edge, int first, int second) const {
    const auto [p, q] = ends(edge, first);
    const auto [r, s] = ends(edge, second);
    const Complex turn = (q - p) / (s - r);
    const Motion rigid{turn / std::abs(turn), 0};
    return {rigid.turn, 0.5 * (p + q) - rigid(0.5 * (r + s))};
  }

  std::vector<int> shared_edges(int a, int b) const {
    const Net& smaller = nets_[static_cast<std::size_t>(
        nets_[static_cast<std::size_t>(a)].faces.size() < nets_[static_cast<std::size_t>(b)].faces.size() ? a : b)];
    const int other = &smaller == &nets_[static_cast<std::size_t>(a)] ? b : a;
    std::vector<int> result;
    for (const int face : smaller.faces) {
      for (const auto& [e, to] : graph_.dual().arcs(face)) {
        still_working(20);
        if (!graph_.edges()[static_cast<std::size_t>(e)].cut && net_of(to) == other) result.push_back(e);
      }
    }
    std::sort(result.begin(), result.end(), [&](int x, int y) {
      const double first = graph_.edges()[static_cast<std::size_t>(x)].length;
      const double second = graph_.edges()[static_cast<std::size_t>(y)].length;
      return first != second ? first > second : x < y;
    });
    return result;
  }

  /// Those of the shared edges that a motion of the second net brings together.
  std::vector<int> hinges(const std::vector<int>& shared, int first, int second, const Motion& motion) const {
    std::vector<int> result;
    for (const int e : shared) {
      const double tolerance = closure * graph_.edges()[static_cast<std::size_t>(e)].length;
      const auto [p, q] = ends(e, first);
      const auto [r, s] = ends(e, second);
      if (std::abs(motion(r) - p) <= tolerance && std::abs(motion(s) - q) <= tolerance) result.push_back(e);
    }
    return result;
  }

  /// Every way to join two nets.
  void propose(int a, int b) {
    const unsigned version = ++versions_[key(a, b)];
    std::vector<int> left = shared_edges(a, b);
    const std::vector<int> shared = left;
    while (!left.empty()) {
      const int e = left.front();
      const auto& edge = graph_.edges()[static_cast<std::size_t>(e)];
      std::vector<int> joined;
      const auto [r, s] = ends(e, b);
      if (edge.length > 0 && r != s) joined = hinges(shared, a, b, onto(e, a, b));
      double price = 0;
      for (const int h : joined) {
        price += graph_.edges()[static_cast<std::size_t>(h)].cost;
      }
      if (!joined.empty()) {
        const double step = price_step * std::sqrt(area_);
        queue_.push({static_cast<std::int64_t>(std::llround(price / step)),
                     depth(edge.faces[0]) + depth(edge.faces[1]),
                     std::max(net(a).area, net(b).area),
                     {a, b},
                     e,
                     version});
      }
      left.erase(
          std::remove_if(left.begin(), left.end(),
                         [&](int x) { return x == e || std::find(joined.begin(), joined.end(), x) != joined.end(); }),
          left.end());
    }
  }
  int& depth(int face) { return depth_[static_cast<std::size_t>(facet_of_face_[static_cast<std::size_t>(face)])]; }

  void join(const Joint& joint) {
    auto [fixed, moved] = joint.nets;
    if (net(fixed).faces.size() < net(moved).faces.size()) std::swap(fixed, moved);
    const Motion motion = onto(joint.edge, fixed, moved);
    const std::vector<int> joined = hinges(shared_edges(fixed, moved), fixed, moved, motion);
    if (dangles(joint.edge, joined, fixed, moved)) return;
    std::vector<PlaneTriangle> triangles = net(moved).triangles.moved(motion);
    still_working(joining_nanoseconds * static_cast<double>(triangles.size()));
    for (const PlaneTriangle& t : triangles) {
      if (net(fixed).triangles.overlaps(t)) return;
    }
    for (const int e : joined) is_hinge_[static_cast<std::size_t>(e)] = true;
    const auto& faces = graph_.edges()[static_cast<std::size_t>(joint.edge)].faces;
    const int root = net(fixed).area >= net(moved).area ? fixed : moved;
    const int near = net_of(faces[0]) == root ? faces[0] : faces[1];
    const int far = near == faces[0] ? faces[1] : faces[0];
    depth(far) = std::max(depth(far), depth(near) + 1);

    std::set<int> beside;
    for (const int face : net(moved).faces) {
      for (const auto& [e, to] : graph_.dual().arcs(face)) {
        const int other = net_of(to);
        if (!graph_.edges()[static_cast<std::size_t>(e)].cut && other != fixed && other != moved) beside.insert(other);
      }
    }
    for (const int face : net(moved).faces) {
      net_of_face_[static_cast<std::size_t>(face)] = fixed;
      for (int c = piece_.face_offsets[static_cast<std::size_t>(face)];
           c < piece_.face_offsets[static_cast<std::size_t>(face) + 1]; ++c) {
        z_[static_cast<std::size_t>(c)] = motion(z_[static_cast<std::size_t>(c)]);
      }
    }
    ++versions_[key(fixed, moved)];
    for (const int other : beside) ++versions_[key(moved, other)];
    Net& whole = net(fixed);
    Net& part = net(moved);
    whole.faces.insert(whole.faces.end(), part.faces.begin(), part.faces.end());
    whole.triangles.add(std::move(triangles));
    whole.area += part.area;
    part = {};
    for (const int other : beside) propose(fixed, other);
  }

  /// Whether the hinges, taken for one segment about the middle of an edge, are short for both nets.
  bool dangles(int edge, const std::vector<int>& joined, int a, int b) {
    double hinge = 0;
    for (const int e : joined) hinge += graph_.edges()[static_cast<std::size_t>(e)].length;
    // The smaller net first: as a rule it is narrow, and the other need not be looked at.
    if (net(b).faces.size() < net(a).faces.size()) std::swap(a, b);
    for (const int i : {a, b}) {
      const auto [p, q] = ends(edge, i);
      const Complex half = 0.5 * hinge * (q - p) / std::abs(q - p);
      const Complex middle = 0.5 * (p + q);
      if (!net(i).triangles.is_wider_along(middle - half, middle + half, hinge / min_hinge)) return false;
    }
    return true;
  }

  const Piece& piece_;
  const SeamGraph& graph_;
  double area_ = 0;
  std::vector<std::array<std::array<int, 2>, 2>> corners_;  ///< per edge and face: of its first and second vertex
  std::vector<Complex> z_;                                  ///< per corner, in the plane of its net
  std::vector<int> net_of_face_;
  std::vector<int> facet_of_face_;
  std::vector<int> depth_;  ///< per facet
  std::vector<Net> nets_;
  std::vector<bool> is_hinge_;  ///< per edge
  std::priority_queue<Joint> queue_;
  std::unordered_map<std::uint64_t, unsigned> versions_;  ///< per pair of nets: joints of earlier ones are void
};

}  // namespace

std::vector<int> rigid_unfolding_seams(const Piece& piece, const SeamGraph& graph) {
  Unfolder unfolder(piece, graph);
  if (!unfolder.has_few_facets()) return {};
  unfolder.join_all();
  return unfolder.seams();
}

}  // namespace spectral_conformal
