#pragma once

#include <array>
#include <vector>

#include "geometry/plane_box.h"

namespace spectral_conformal {

/// A balanced binary tree of boxes, built in O(n log n), that finds the boxes meeting a given one.
class BoxTree {
 public:
  static BoxTree over(const std::vector<PlaneBox>& boxes);

  /// Calls visit(index) for the boxes that meet `box`, until it returns false.
  template <class Visit>
  void for_each_meeting(const PlaneBox& box, Visit&& visit) const {
    // Twice the depth of a balanced tree with INT_MAX boxes.
    std::array<int, 64> stack;
    int top = 0;
    if (!nodes_.empty()) stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--top])];
      if (!node.box.meets(box)) continue;
      if (node.second_child > 0) {
        stack[top++] = node.second_child;
        stack[top++] = static_cast<int>(&node - nodes_.data()) + 1;
        continue;
      }
      if (!visit(node.index)) return;
    }
  }

 private:
  struct Leaf {
    PlaneBox box;
    int index;
  };
  struct Node {
    PlaneBox box;
    int index;         ///< of a leaf's box
    int second_child;  ///< the first child follows the node; 0 for a leaf
  };

  int build(std::vector<Leaf>& leaves, int first, int last);

  std::vector<Node> nodes_;
};

}  // namespace spectral_conformal
