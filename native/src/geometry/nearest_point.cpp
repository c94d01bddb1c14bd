#include "geometry/nearest_point.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace spectral_conformal {
namespace {

double coordinate(Complex p, char axis) { return axis == 0 ? p.real() : p.imag(); }

}  // namespace

NearestPoint NearestPoint::among(const std::vector<Complex>& points) {
  NearestPoint tree;
  tree.axis_.assign(points.size(), 0);
  tree.leaves_.reserve(points.size());
  for (const Complex p : points) tree.leaves_.push_back({p, static_cast<int>(tree.leaves_.size())});
  tree.build(0, static_cast<int>(points.size()));
  return tree;
}

void NearestPoint::build(int first, int last) {
  if (last - first < 2) return;
  const auto begin = leaves_.begin();
  const auto extent = [&](char axis) {
    const auto [low, high] = std::minmax_element(begin + first, begin + last, [axis](const Leaf& a, const Leaf& b) {
      return coordinate(a.point, axis) < coordinate(b.point, axis);
    });
    return coordinate(high->point, axis) - coordinate(low->point, axis);
  };
  const char axis = extent(0) >= extent(1) ? 0 : 1;
  const int middle = first + (last - first) / 2;
  std::nth_element(begin + first, begin + middle, begin + last, [axis](const Leaf& a, const Leaf& b) {
    const double here = coordinate(a.point, axis);
    const double there = coordinate(b.point, axis);
    return here != there ? here < there : a.index < b.index;
  });
  axis_[static_cast<std::size_t>(middle)] = axis;
  build(first, middle);
  build(middle + 1, last);
}

int NearestPoint::to(Complex point) const {
  struct Range {
    int first;
    int last;
    double least;  ///< lower bound of the squared distance to its points
  };
  // One entry per level of a balanced tree with INT_MAX points.
  std::array<Range, 64> stack;
  int top = 0;
  stack[top++] = {0, static_cast<int>(leaves_.size()), 0};
  int best = leaves_.front().index;
  double nearest = infinity;
  while (top > 0) {
    const auto [first, last, least] = stack[--top];
    if (first == last || least > nearest) continue;
    const int middle = first + (last - first) / 2;
    const Leaf& leaf = leaves_[static_cast<std::size_t>(middle)];
    const double square = std::norm(leaf.point - point);
    if (square < nearest || (square == nearest && leaf.index < best)) {
      nearest = square;
      best = leaf.index;
    }
    const char axis = axis_[static_cast<std::size_t>(middle)];
    const double across = coordinate(point, axis) - coordinate(leaf.point, axis);
    const Range low{first, middle, across > 0 ? std::max(least, across * across) : least};
    const Range high{middle + 1, last, across < 0 ? std::max(least, across * across) : least};
    stack[top++] = across < 0 ? high : low;
    stack[top++] = across < 0 ? low : high;
  }
  return best;
}

}  // namespace spectral_conformal
