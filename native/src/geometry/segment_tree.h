#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A segment whose ends move at constant speeds for a time of 1.
struct MovingSegment {
  Complex from;
  Complex to;
  Complex from_motion;  ///< in the whole time
  Complex to_motion;
};

/// A disk that moves at a constant speed for a time of 1.
struct MovingDisk {
  Complex center;
  double radius = 0;
  Complex motion = 0;
};

/// A balanced binary tree of segments, built in O(n log n), that finds those that a disk may meet. Its nodes have an
/// axis-aligned box and, around segments that are not short beside it, a slab along the longest: boxes of long edges
/// beside each other all meet.
class SegmentTree {
 public:
  static SegmentTree over(const std::vector<MovingSegment>& segments);

  /// Calls visit(index) for the segments that the disk may meet at some time, until it returns false: all that it
  /// meets, those whose box and line it meets, and some that move fast. Segments that move as the disk does, as
  /// neighbors do on a map that grows or turns, do not meet it, however long their way.
  template <class Visit>
  void for_each_meeting(const MovingDisk& disk, Visit&& visit) const {
    // Twice the depth of a balanced tree with INT_MAX segments.
    std::array<int, 64> stack;
    int top = 0;
    if (!nodes_.empty()) stack[top++] = 0;
    while (top > 0) {
      const int k = stack[--top];
      const Node& node = nodes_[static_cast<std::size_t>(k)];
      if (!meets(node, disk)) continue;
      if (node.second_child > 0) {
        stack[top++] = node.second_child;
        stack[top++] = k + 1;
        continue;
      }
      if (!visit(node.index)) return;
    }
  }

 private:
  /// Places and motions of the ends of segments along an axis.
  struct Extent {
    double low = infinity;
    double high = -infinity;
    double slowest = infinity;
    double fastest = -infinity;

    void include(double place, double motion);
  };
  struct Node {
    std::array<Extent, 3> extents;  ///< along 1, i and the normal
    Complex normal = 0;             ///< of the longest segment, as long as it; 0 without a slab
    double length = 0;              ///< of the normal
    double rounding = 0;            ///< of products of a place with the normal
    int index = 0;                  ///< of a leaf's segment
    int second_child = 0;           ///< the first child follows the node; 0 for a leaf
  };

  static bool meets(const Node& node, const MovingDisk& disk);
  int build(const std::vector<MovingSegment>& segments, std::vector<int>& order, int first, int last);

  std::vector<Node> nodes_;
};

}  // namespace spectral_conformal
