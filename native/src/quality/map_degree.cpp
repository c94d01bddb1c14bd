#include "quality/map_degree.h"

#include <algorithm>
#include <limits>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/box_tree.h"
#include "geometry/orientation.h"
#include "geometry/simple_polygons.h"
#include "graph/disjoint_sets.h"
#include "quality/flips.h"

namespace spectral_conformal {
namespace {

struct BoundaryEdge {
  int from;
  int to;
  int loop;
};

/// The images of all boundary edges. The map must outlive this object.
class Boundary {
 public:
  Boundary(const std::vector<BoundaryLoop>& loops, const ComplexVector& z)
      : z_(z), edges_(edges_of(loops)), tree_(BoxTree::over(boxes_of(edges_, z))) {}

  std::size_t n_edges() const { return edges_.size(); }

  /// Whether the interior of a counterclockwise triangle is certainly free of the boundary. Never if its box meets many
  /// edges: thin triangles side by side would test all pairs.
  bool is_off(const std::array<int, 3>& triangle) const {
    bool off = true;
    std::size_t met = 0;
    tree_.for_each_meeting(PlaneBox::of({z_[triangle[0]], z_[triangle[1]], z_[triangle[2]]}), [&](int i) {
      off = ++met <= pairs_of_each && is_off(triangle, edge(i));
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
    run_blocks_in_parallel(triangles_.size(), std::size_t{3000}, [&](std::size_t begin, std::size_t end) {
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

/// The loops of three and more vertices: one of two is the coincident banks of a slit.
std::vector<BoundaryLoop> without_slits(std::vector<BoundaryLoop> loops) {
  const auto is_slit = [](const BoundaryLoop& loop) { return loop.size() == 2; };
  loops.erase(std::remove_if(loops.begin(), loops.end(), is_slit), loops.end());
  return loops;
}

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

/// has_degree_at_most_one of loops without slits.
bool bound_degree(const std::vector<BoundaryLoop>& wide, const ComplexVector& z) {
  return has_one_outer_loop(wide, z) && are_simple_polygons(wide, z);
}

}  // namespace

bool has_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  return bound_degree(without_slits(loops), z);
}

bool have_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  const std::vector<BoundaryLoop> wide = without_slits(loops);
  if (!are_simple_polygons(wide, z)) return false;
  const ComplexVector turned = narrow(wide, z);
  const Boundary boundary(wide, turned);
  std::size_t budget = pairs_of_each * boundary.n_edges();
  for (std::size_t k = 0; k < wide.size(); ++k) {
    if (orientation_of_simple(wide[k], turned) < 0) continue;
    if (boundary.winding_number(turned[wide[k].front()], static_cast<int>(k), budget) > 0 || budget == 0) return false;
  }
  return true;
}

std::vector<int> overlap_suspects(const std::vector<std::array<int, 3>>& triangles,
                                  const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  const std::vector<BoundaryLoop> wide = without_slits(loops);
  if (bound_degree(wide, z)) return non_positive_triangles(triangles, z);
  const ComplexVector turned = narrow(wide, z);
  return DegreeTest(triangles, loops, Boundary(wide, turned), turned).higher();
}

}  // namespace spectral_conformal
