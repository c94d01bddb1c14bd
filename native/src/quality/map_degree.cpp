#include "quality/map_degree.h"

#include <algorithm>

#include "geometry/orientation.h"
#include "quality/box_tree.h"

namespace spectral_conformal {
namespace {

struct BoundaryEdge {
  int from;
  int to;
};

/// Whether two boundary edges have no point in common but the vertex that neighbours share.
bool are_apart(const BoundaryEdge& first, const BoundaryEdge& second, const ComplexVector& z) {
  const auto doubles_back = [&](int before, int shared, int after) {
    if (orientation(z[before], z[shared], z[after]) != 0) return false;
    const Complex back = z[before] - z[shared];
    const Complex on = z[after] - z[shared];
    return !(back.real() * on.real() + back.imag() * on.imag() < 0);
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

bool are_simple(const std::vector<BoundaryEdge>& edges, const ComplexVector& z) {
  std::vector<PlaneBox> boxes;
  boxes.reserve(edges.size());
  for (const BoundaryEdge& edge : edges) {
    const Complex a = z[edge.from];
    const Complex b = z[edge.to];
    boxes.push_back({{std::min(a.real(), b.real()), std::min(a.imag(), b.imag())},
                     {std::max(a.real(), b.real()), std::max(a.imag(), b.imag())}});
  }
  const BoxTree tree(boxes);
  bool simple = true;
  for (int i = 0; simple && i < static_cast<int>(edges.size()); ++i) {
    tree.for_each_meeting(boxes[static_cast<std::size_t>(i)], [&](int other) {
      // Each pair once.
      if (other <= i) return true;
      simple = are_apart(edges[static_cast<std::size_t>(i)], edges[static_cast<std::size_t>(other)], z);
      return simple;
    });
  }
  return simple;
}

/// The orientation of a simple loop: that of the corner at its lowest vertex in lexicographic order, which is convex. 0
/// only for a loop that is not simple.
int orientation_of_simple(const BoundaryLoop& loop, const ComplexVector& z) {
  const auto before = [&](int a, int b) {
    return z[a].real() != z[b].real() ? z[a].real() < z[b].real() : z[a].imag() < z[b].imag();
  };
  const auto n = loop.size();
  const auto lowest = static_cast<std::size_t>(std::min_element(loop.begin(), loop.end(), before) - loop.begin());
  return orientation(z[loop[(lowest + n - 1) % n]], z[loop[lowest]], z[loop[(lowest + 1) % n]]);
}

}  // namespace

bool has_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  int counter_clockwise = 0;
  std::vector<BoundaryEdge> edges;
  for (const BoundaryLoop& loop : loops) {
    if (loop.size() == 2) continue;  // the two banks of a slit, that lie on each other
    const int sense = orientation_of_simple(loop, z);
    if (sense == 0) return false;
    if (sense > 0) ++counter_clockwise;
    for (std::size_t i = 0; i < loop.size(); ++i) edges.push_back({loop[i], loop[(i + 1) % loop.size()]});
  }
  return counter_clockwise == 1 && are_simple(edges, z);
}

}  // namespace spectral_conformal
