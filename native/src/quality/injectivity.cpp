#include "quality/injectivity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "quality/box_tree.h"

namespace spectral_conformal {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The orientation of a, b, c: 1, -1, or 0 where rounding does not let it be told (Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates", the first filter of orient2d).
int certain_orientation(Complex a, Complex b, Complex c) {
  const double left = (b.real() - a.real()) * (c.imag() - a.imag());
  const double right = (b.imag() - a.imag()) * (c.real() - a.real());
  // Shewchuk's unit of rounding is epsilon / 2. The smallest normal number covers products that underflow.
  const double error = 2 * epsilon * (std::abs(left) + std::abs(right)) + std::numeric_limits<double>::min();
  const double twice_area = left - right;
  if (twice_area > error) return 1;
  return twice_area < -error ? -1 : 0;
}

struct BoundaryEdge {
  int from;
  int to;
};

/// Whether two boundary edges certainly have no point in common but the vertex that neighbours share.
bool certainly_apart(const BoundaryEdge& first, const BoundaryEdge& second, const ComplexVector& z) {
  const auto fold = [&](int before, int shared, int after) {
    if (certain_orientation(z[before], z[shared], z[after]) != 0) return false;
    const Complex back = z[before] - z[shared];
    const Complex on = z[after] - z[shared];
    return !(back.real() * on.real() + back.imag() * on.imag() < 0);
  };
  if (first.to == second.from && first.from == second.to) return false;
  if (first.to == second.from) return !fold(first.from, first.to, second.to);
  if (first.from == second.to) return !fold(second.from, second.to, first.to);
  const auto on_one_side = [&](const BoundaryEdge& line, const BoundaryEdge& edge) {
    const int side = certain_orientation(z[line.from], z[line.to], z[edge.from]);
    return side != 0 && side == certain_orientation(z[line.from], z[line.to], z[edge.to]);
  };
  return on_one_side(first, second) || on_one_side(second, first);
}

bool certainly_simple(const std::vector<BoundaryEdge>& edges, const ComplexVector& z) {
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
      simple = certainly_apart(edges[static_cast<std::size_t>(i)], edges[static_cast<std::size_t>(other)], z);
      return simple;
    });
  }
  return simple;
}

/// 1 for a loop that certainly runs counter-clockwise, -1 for clockwise, 0 in doubt.
int certain_sense(const BoundaryLoop& loop, const ComplexVector& z) {
  double twice_area = 0;
  double magnitude = 0;
  const Complex origin = z[loop.front()];
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Complex a = z[loop[i]] - origin;
    const Complex b = z[loop[i + 1]] - origin;
    twice_area += a.real() * b.imag() - a.imag() * b.real();
    magnitude += std::abs(a.real() * b.imag()) + std::abs(a.imag() * b.real());
  }
  const double error = static_cast<double>(loop.size() + 4) * epsilon * magnitude + std::numeric_limits<double>::min();
  if (twice_area > error) return 1;
  return twice_area < -error ? -1 : 0;
}

}  // namespace

bool has_degree_at_most_one(const std::vector<BoundaryLoop>& loops, const ComplexVector& z) {
  int counter_clockwise = 0;
  std::vector<BoundaryEdge> edges;
  for (const BoundaryLoop& loop : loops) {
    const int sense = certain_sense(loop, z);
    if (sense == 0) return false;
    if (sense > 0) ++counter_clockwise;
    for (std::size_t i = 0; i < loop.size(); ++i) edges.push_back({loop[i], loop[(i + 1) % loop.size()]});
  }
  return counter_clockwise == 1 && certainly_simple(edges, z);
}

std::vector<int> doubtful_triangles(const std::vector<std::array<int, 3>>& triangles, const ComplexVector& z) {
  std::vector<int> result;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (certain_orientation(z[a], z[b], z[c]) != 1) result.push_back(static_cast<int>(t));
  }
  return result;
}

}  // namespace spectral_conformal
