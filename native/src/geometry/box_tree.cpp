#include "geometry/box_tree.h"

#include <algorithm>

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {

BoxTree BoxTree::over(const std::vector<PlaneBox>& boxes) {
  BoxTree tree;
  std::vector<Leaf> leaves;
  leaves.reserve(boxes.size());
  for (const PlaneBox& box : boxes) leaves.push_back({box, static_cast<int>(leaves.size())});
  tree.nodes_.reserve(2 * boxes.size());
  if (!boxes.empty()) tree.build(leaves, 0, static_cast<int>(boxes.size()));
  return tree;
}

int BoxTree::build(std::vector<Leaf>& leaves, int first, int last) {
  PlaneBox box = leaves[static_cast<std::size_t>(first)].box;
  for (int i = first + 1; i < last; ++i) box.include(leaves[static_cast<std::size_t>(i)].box);
  const int node = static_cast<int>(nodes_.size());
  nodes_.push_back({box, leaves[static_cast<std::size_t>(first)].index, 0});
  poll(last - first);
  if (last - first == 1) return node;
  const Complex size = box.size();
  const int axis = size.real() >= size.imag() ? 0 : 1;
  const int middle = first + (last - first) / 2;
  // Half the sum of both ends; the index makes the order the same on every platform.
  std::nth_element(leaves.begin() + first, leaves.begin() + middle, leaves.begin() + last,
                   [axis](const Leaf& a, const Leaf& b) {
                     const double center_a = 0.5 * a.box.low[axis] + 0.5 * a.box.high[axis];
                     const double center_b = 0.5 * b.box.low[axis] + 0.5 * b.box.high[axis];
                     return center_a != center_b ? center_a < center_b : a.index < b.index;
                   });
  build(leaves, first, middle);
  const int second = build(leaves, middle, last);
  nodes_[static_cast<std::size_t>(node)].second_child = second;
  return node;
}

}  // namespace spectral_conformal
