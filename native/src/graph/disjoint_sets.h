#pragma once

#include <vector>

namespace spectral_conformal {

/// A partition of 0, 1, ..., n - 1 that only grows coarser (union-find with path halving; Tarjan and van Leeuwen 1984).
/// Each set is named by one of its elements, its root. Not boost::disjoint_sets, which names a set by rank: here the
/// root is the smallest element, whatever the order of the unions, or the one that the caller says, and results that
/// are numbered by roots do not depend on that order.
class DisjointSets {
 public:
  /// n sets of one element each.
  explicit DisjointSets(int n);
  /// The root of the set that `element` is in.
  int find(int element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }
  /// Unites the sets of two elements; the smaller root becomes the root. False where they are one set already.
  bool unite(int a, int b) {
    a = find(a);
    b = find(b);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
    return a != b;
  }
  /// Puts the set of the root `child` under the root `root`, which names both from then on.
  void attach(int child, int root) { parent_[child] = root; }

 private:
  std::vector<int> parent_;
};

}  // namespace spectral_conformal
