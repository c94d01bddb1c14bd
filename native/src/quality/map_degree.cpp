#include "quality/map_degree.h"

#include <algorithm>
#include <limits>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/box_tree.h"
#include "geometry/orientation.h"
#include "geometry/signed_area.h"
#include "graph/disjoint_sets.h"
#include "quality/flips.h"

namespace spectral_conformal {
namespace {

struct BoundaryEdge {
  int from;
  int to;
  int loop;
};

/// Whether two boundary edges are disjoint except for the shared vertex of neighbors.
bool are_apart(const BoundaryEdge& first, const BoundaryEdge& second, const ComplexVector& z) {
  const auto doubles_back = [&](int before, int shared, int after) {
    if (orientation(z[before], z[shared], z[after]) != 0) return false;
    const Complex back = z[before] - z[shared];
    const Complex on = z[after] - z[shared];
    return !(dot(back, on) < 0);
  };
  if (first.to == second.from && first.from == second.to) return false;
  if (first.to == second.from) return !doubles_back(first.from, first.to, second.to);
  if (first.from == second.to) return !doubles_back(second.from, second.to, first.to);
  const auto on_one_side = [&](const BoundaryEdge& line, const BoundaryEdge& edge) {
    const int side = orientation(z[line.from], z[line.to], z[edge.from]);
    return side != 0 && side == orientation(z[line.from], z[line.to], z[edge.to]);
  };
  return on_one_side(first, second) || on_one_side(second, first);
}

/// The images of all boundary edges. The map must outlive this object.
class Boundary {
 public:
  /// Omits loops of two vertices: they are the two coincident banks of a slit.
  Boundary(const std::vector<BoundaryLoop>& loops, const ComplexVector& z)
      : z_(z), edges_(edges_of(loops)), boxes_(boxes_of(edges_, z)), tree_(BoxTree::over(boxes_)) {}

  std::size_t n_edges() const { return edges_.size(); }

  /// Whether all edges are disjoint except for the shared vertices of neighbors. Subtracts the edges visited from
  /// `budget`, and returns false when it is used up.
  bool is_simple(std::size_t& budget) const {
    bool simple = true;
    for (int i = 0; simple && i < static_cast<int>(edges_.size()); ++i) {
      tree_.for_each_meeting(box(i), [&](int other) {
        if (budget == 0) return simple = false;
        --budget;
        // Visit each pair once.
        if (other <= i) return true;
        simple = are_apart(edge(i), edge(other), z_);
        return simple;
      });
    }
    return simple;
  }

  bool is_simple() const {
    std::size_t budget = no_limit;
    return is_simple(budget);
  }

  /// Whether the interior of a counterclockwise triangle is certainly free of the boundary.
  bool is_off(const std::array<int, 3>& triangle) const {
    bool off = true;
    tree_.for_each_meeting(PlaneBox::of({z_[triangle[0]], z_[triangle[1]], z_[triangle[2]]}), [&](int i) {
      off = is_off(triangle, edge(i));
      return off;
    });
    return off;
  }

  /// The sum of the winding numbers of all loops about a point on none of them.
  int winding_number(Complex p) const {
    std::size_t budget = no_limit;
    return winding_number(p, -1, budget);
  }
  /// The same for all loops but one. Subtracts the edges visited from `budget`; incomplete
  /// when that is used up.
  int winding_number(Complex p, int left_out, std::size_t& budget) const {
    int result = 0;
    // Count the crossings of a ray to the right.
    const PlaneBox ray{{p.real(), p.imag()}, {infinity, p.imag()}};
    tree_.for_each_meeting(ray, [&](int i) {
      if (budget == 0) return false;
      --budget;
      if (edge(i).loop == left_out) return true;
      const Complex from = z_[edge(i).from];
      const Complex to = z_[edge(i).to];
      if (from.imag() <= p.imag() && to.imag() > p.imag() && orientation(from, to, p) > 0) ++result;
      if (from.imag() > p.imag() && to.imag() <= p.imag() && orientation(from, to, p) < 0) --result;
      return true;
    });
    return result;
  }

 private:
  static std::vector<BoundaryEdge> edges_of(const std::vector<BoundaryLoop>& loops) {
    std::vector<BoundaryEdge> result;
    for (std::size_t k = 0; k < loops.size(); ++k) {
      const BoundaryLoop& loop = loops[k];
      if (loop.size() == 2) continue;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        result.push_back({loop[i], loop[(i + 1) % loop.size()], static_cast<int>(k)});
      }
    }
    return result;
  }
  static std::vector<PlaneBox> boxes_of(const std::vector<BoundaryEdge>& edges, const ComplexVector& z) {
    std::vector<PlaneBox> result;
    result.reserve(edges.size());
    for (const BoundaryEdge& edge : edges) result.push_back(PlaneBox::of({z[edge.from], z[edge.to]}));
    return result;
  }
  const BoundaryEdge& edge(int i) const { return edges_[static_cast<std::size_t>(i)]; }
  const PlaneBox& box(int i) const { return boxes_[static_cast<std::size_t>(i)]; }

  /// The same for an edge whose box meets that of the triangle.
  bool is_off(const std::array<int, 3>& triangle, const BoundaryEdge& edge) const {
    const auto has = [&](int v) { return std::find(triangle.begin(), triangle.end(), v) != triangle.end(); };
    const bool from = has(edge.from);
    if (from && has(edge.to)) return true;
    if (!from && !has(edge.to)) return false;
    // From a common corner the edge enters the triangle or leaves it.
    const auto k = static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), from ? edge.from : edge.to) -
                                            triangle.begin());
    const Complex corner = z_[triangle[k]];
    const Complex end = z_[from ? edge.to : edge.from];
    return orientation(corner, z_[triangle[(k + 1) % 3]], end) < 0 ||
           orientation(corner, end, z_[triangle[(k + 2) % 3]]) < 0;
  }

  const ComplexVector& z_;
  std::vector<BoundaryEdge> edges_;
  std::vector<PlaneBox> boxes_;
  BoxTree tree_;
};

/// The orientation of a simple loop: that of the corner at its lexicographically smallest vertex, which is convex. 0
/// only for a non-simple loop.
int orientation_of_simple(const BoundaryLoop& loop, const ComplexVector& z) {
  const auto before = [&](int a, int b) { return is_left_of(z[a], z[b]); };
  const auto n = loop.size();
  const auto lowest = static_cast<std::size_t>(std::min_element(loop.begin(), loop.end(), before) - loop.begin());
  return orientation(z[loop[(lowest + n - 1) % n]], z[loop[lowest]], z[loop[(lowest + 1) % n]]);
}

/// Whether exactly one of the loops, if simple, runs counterclockwise.
bool has_one_outer_loop(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  int counterclockwise = 0;
  for (const BoundaryLoop& loop : loops) {
    if (loop.size() == 2) continue;
    const int sense = orientation_of_simple(loop, z);
    if (sense == 0) return false;
    if (sense > 0) ++counterclockwise;
  }
  return counterclockwise == 1;
}

/// Tests for each of some triangles whether the boundary permits a degree above 1 over it.
class DegreeTest {
 public:
  DegreeTest(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
             const Boundary& boundary, const ComplexVector& z)
      : triangles_(triangles),
        boundary_(boundary),
        z_(z),
        on_boundary_(static_cast<std::size_t>(z.size()), 0),
        is_off_(triangles.size(), 0) {
    for (const BoundaryLoop& loop : loops) {
      for (const int v : loop) on_boundary_[v] = 1;
    }
  }

  /// The triangles over which the degree may be above 1, ascending.
  std::vector<int> higher() {
    find_triangles_off_the_boundary();
    // Triangles that share an inner vertex have the same degree: a boundary between them would pass through the vertex.
    DisjointSets joined(static_cast<int>(on_boundary_.size()));
    for_each_polled(triangles_.size(), [&](std::size_t t) {
      const int first = is_off_[t] != 0 ? inner_vertex(t) : -1;
      if (first < 0) return;
      for (const int v : triangles_[t]) {
        if (on_boundary_[v] == 0) joined.unite(first, v);
      }
    });
    std::vector<std::optional<int>> degree(on_boundary_.size());
    std::vector<int> result;
    for_each_polled(triangles_.size(), [&](std::size_t t) {
      if (is_off_[t] == 0 || degree_over(t, joined, degree) > 1) result.push_back(static_cast<int>(t));
    });
    return result;
  }

 private:
  void find_triangles_off_the_boundary() {
    run_blocks_in_parallel(triangles_.size(), 300, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        is_off_[t] = is_positive(triangles_[t], z_) && boundary_.is_off(triangles_[t]) ? 1 : 0;
      }
    });
  }
  int inner_vertex(std::size_t t) const {
    const auto found =
        std::find_if(triangles_[t].begin(), triangles_[t].end(), [&](int v) { return on_boundary_[v] == 0; });
    return found == triangles_[t].end() ? -1 : *found;
  }
  int degree_over(std::size_t t, DisjointSets& joined, std::vector<std::optional<int>>& degree) const {
    const int inner = inner_vertex(t);
    if (inner >= 0) {
      std::optional<int>& known = degree[joined.find(inner)];
      if (!known) known = boundary_.winding_number(z_[inner]);
      return *known;
    }
    const auto& [a, b, c] = triangles_[t];
    const Complex center = z_[a] / 3.0 + z_[b] / 3.0 + z_[c] / 3.0;
    // Rounding may move the center of a thin triangle outside.
    const bool inside = orientation(z_[a], z_[b], center) > 0 && orientation(z_[b], z_[c], center) > 0 &&
                        orientation(z_[c], z_[a], center) > 0;
    return inside ? boundary_.winding_number(center) : std::numeric_limits<int>::max();
  }

  const std::vector<std::array<int, 3>>& triangles_;
  const Boundary& boundary_;
  const ComplexVector& z_;
  std::vector<char> on_boundary_;  ///< per vertex
  std::vector<char> is_off_;       ///< per triangle: counterclockwise and free of the boundary
};

/// The map, turned if it is wide: the rays for winding numbers run to the right, and along the shorter side they meet
/// less of a ribbon, and fewer of many islands in a row. A quarter turn is exact.
ComplexVector narrow(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  PlaneBox box;
  for (const BoundaryLoop& loop : loops) {
    for (const int v : loop) box.include(z[v]);
  }
  const bool is_wide = box.size().real() > box.size().imag();
  return is_wide ? ComplexVector(z * Complex(0, 1)) : z;
}

}  // namespace

bool has_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  return has_one_outer_loop(loops, z) && Boundary(loops, z).is_simple();
}

bool have_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  if (loops.empty()) return true;
  const ComplexVector turned = narrow(loops, z);
  const Boundary boundary(loops, turned);
  std::size_t budget = pairs_of_each * boundary.n_edges();
  if (!boundary.is_simple(budget)) return false;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (loops[k].size() == 2) continue;
    const int sense = orientation_of_simple(loops[k], turned);
    if (sense == 0) return false;
    if (sense > 0 && boundary.winding_number(turned[loops[k].front()], static_cast<int>(k), budget) > 0) return false;
    if (budget == 0) return false;
  }
  return true;
}

std::vector<int> overlap_suspects(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  const ComplexVector turned = narrow(loops, z);
  const Boundary boundary(loops, turned);
  if (has_one_outer_loop(loops, turned) && boundary.is_simple()) return non_positive_triangles(triangles, turned);
  return DegreeTest(triangles, loops, boundary, turned).higher();
}

}  // namespace spectral_conformal
