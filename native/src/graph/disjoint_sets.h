#pragma once

#include <vector>

namespace spectral_conformal {

/// A partition of 0, 1, ..., n - 1 that only grows coarser (union-find with path halving; Tarjan and van Leeuwen 1984).
/// Each set is represented by one of its elements, its root: the smallest element, or the one chosen by the caller. Not
/// boost::disjoint_sets, whose roots depend on rank: here results numbered by roots do not depend on the order of the
/// unions.
class DisjointSets {
 public:
  /// n sets of one element each.
  explicit DisjointSets(int n);
  /// Again n sets of one element each, in the same memory.
  void separate();
  /// The root of the set of `element`.
  int find(int element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }
  /// Unites the sets of two elements; the smaller root becomes the root. Returns false if they are one set already.
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
  /// Attaches the set of the root `child` to the root `root`, which then represents both.
  void attach(int child, int root) { parent_[child] = root; }

 private:
  std::vector<int> parent_;
};

}  // namespace spectral_conformal
