#pragma once

#include <algorithm>
#include <array>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "graph/grouped.h"

namespace spectral_conformal {

/// The edges between the vertices 0 to n_vertices - 1, and the values that lie at them, such as faces or half-edges.
template <class T>
class EdgeTable {
 public:
  struct Entry {
    int larger;  ///< the edge's larger vertex
    T value;
    bool operator<(const Entry& other) const {
      return larger != other.larger ? larger < other.larger : value < other.value;
    }
  };

  /// `for_each(visit)` calls visit(a, b, value) for every value, where a and b are the ends of its edge in any order.
  /// It is called twice and must visit the same values in the same order.
  template <class ForEach>
  EdgeTable(int n_vertices, const ForEach& for_each)
      : entries_(n_vertices, [&](const auto& visit) {
          for_each([&](int a, int b, const T& value) { visit(std::min(a, b), Entry{std::max(a, b), value}); });
        }) {
    run_blocks_in_parallel(n_vertices, 5000, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) std::sort(entries_[v].begin(), entries_[v].end());
    });
  }

  /// Calls visit(ends, first, last) for every edge: the smaller end first, and its values, ascending, in the entries
  /// from first to last. The edges come in lexicographic order.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (int v = 0; v < entries_.n_keys(); ++v) {
      const auto [begin, end] = entries_[v];
      for (const Entry *first = begin, *last = begin; first != end; first = last) {
        while (last != end && last->larger == first->larger) ++last;
        visit(std::array<int, 2>{v, first->larger}, first, last);
      }
      poll();
    }
  }
  std::size_t n_edges() const {
    std::size_t n = 0;
    for_each_edge([&](const auto& /*ends*/, const Entry* /*first*/, const Entry* /*last*/) { ++n; });
    return n;
  }

 private:
  Grouped<Entry> entries_;
};

}  // namespace spectral_conformal
