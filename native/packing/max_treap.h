#pragma once

#include <vector>

namespace spectral_conformal {

/// A sequence of items with values that finds the nearest item with a value above a limit: a treap (Seidel and Aragon
/// 1996, "Randomized Search Trees") whose nodes store the largest value in their subtree. All operations take O(log n)
/// on average; the priorities are the same in each run. Items are numbers from 0; `none` stands for no item.
class MaxTreap {
 public:
  static constexpr int none = -1;

  /// Inserts a new item before another one, or, for `none`, at the end.
  void insert_before(int at, int item, double value);
  void erase(int item);
  double value(int item) const { return nodes_[static_cast<std::size_t>(item)].value; }
  void set_value(int item, double value);

  /// The first item with a value above the limit.
  int first_above(double limit) const { return first_above_in(root_, limit); }
  /// The first such item after a given one.
  int next_above(int item, double limit) const;
  /// The last such item before a given one.
  int previous_above(int item, double limit) const;
  /// The first item for which is_behind holds. Precondition: it then holds for all later items.
  template <class Predicate>
  int first_behind(const Predicate& is_behind) const {
    int found = none;
    for (int at = root_; at != none;) {
      if (is_behind(at)) {
        found = at;
        at = node(at).child[0];
      } else {
        at = node(at).child[1];
      }
    }
    return found;
  }

 private:
  struct Node {
    double value = 0;
    double largest = 0;  ///< of the node and of all below it
    int parent = none;
    int child[2] = {none, none};  ///< before, behind
  };

  const Node& node(int item) const { return nodes_[static_cast<std::size_t>(item)]; }
  Node& node(int item) { return nodes_[static_cast<std::size_t>(item)]; }
  /// Which of its parent's children an item is.
  int side_of(int item) const { return node(node(item).parent).child[1] == item ? 1 : 0; }
  bool has_above(int item, double limit) const { return item != none && node(item).largest > limit; }
  int first_above_in(int item, double limit) const { return outermost_above(item, limit, 0); }
  int outermost_above(int item, double limit, int side) const;
  int nearest_above(int item, double limit, int side) const;
  double largest_below(int item) const;
  void update_up(int item);
  void replace(int item, int by);
  /// Rotates a node into the position of its parent, which becomes its child.
  void rotate_up(int item);

  std::vector<Node> nodes_;
  int root_ = none;
};

}  // namespace spectral_conformal
