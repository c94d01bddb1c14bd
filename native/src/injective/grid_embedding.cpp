#include "injective/grid_embedding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "graph/grouped.h"

namespace spectral_conformal {
namespace {

/// The neighbors of each vertex, counterclockwise; for a vertex of the outer loop from its successor to its predecessor
/// in the loop.
class Rotations {
 public:
  Rotations(const std::vector<std::array<int, 3>>& triangles, int n)
      : corners_(n, [&](const auto& visit) {
          for (const auto& triangle : triangles) {
            for (int k = 0; k < 3; ++k) visit(triangle[k], Corner{triangle[(k + 1) % 3], triangle[(k + 2) % 3]});
          }
        }) {
    // Every directed edge has one triangle to its left.
    for (int v = 0; v < n; ++v) {
      const auto [first, last] = corners_[v];
      std::sort(first, last);
      const auto same = [](const Corner& a, const Corner& b) { return a.from == b.from; };
      if (std::adjacent_find(first, last, same) != last) is_simple_ = false;
    }
  }

  bool is_simple() const { return is_simple_; }
  /// The neighbor of v that follows `w` counterclockwise; -1 if no triangle lies between them.
  int next(int v, int w) const {
    const auto [first, last] = corners_[v];
    const Corner* const found = std::lower_bound(first, last, Corner{w, -1});
    return found == last || found->from != w ? -1 : found->to;
  }
  template <class Visit>
  void for_each_neighbor(int v, const Visit& visit) const {
    for (const Corner& corner : corners_[v]) visit(corner.from);
  }

 private:
  /// A triangle at a vertex, by its other vertices.
  struct Corner {
    int from;
    int to;
    bool operator<(const Corner& other) const { return from != other.from ? from < other.from : to < other.to; }
  };
  Grouped<Corner> corners_;
  bool is_simple_ = true;
};

/// A canonical order (de Fraysseix, Pach and Pollack 1990), found from its end: each vertex is removed from the border
/// of the remaining graph, where no edge at it may be a chord of the border.
class CanonicalOrder {
 public:
  /// A vertex, and the border below it from left to right: its neighbors among the earlier vertices.
  struct Step {
    int vertex;
    std::vector<int> below;
  };

  /// The first edge of the loop is the base and stays.
  CanonicalOrder(const Rotations& rotations, const BoundaryLoop& loop, int n)
      : rotations_(rotations),
        first_(loop[0]),
        second_(loop[1]),
        left_(static_cast<std::size_t>(n), -1),
        right_(static_cast<std::size_t>(n), -1),
        n_chords_(static_cast<std::size_t>(n), 0),
        state_(static_cast<std::size_t>(n), State::within) {
    // Seen from the base, the loop runs from right to left.
    for (std::size_t i = 1; i < loop.size(); ++i) {
      const int left = loop[(i + 1) % loop.size()];
      left_[loop[i]] = left;
      right_[left] = loop[i];
    }
    for (const int v : loop) state_[v] = State::border;
    for (const int v : loop) {
      rotations.for_each_neighbor(v, [&](int w) { n_chords_[v] += is_chord(v, w) ? 1 : 0; });
    }
    for (const int v : loop) offer(v);
  }

  /// The steps from last to first; if there is no canonical order, fewer than the vertices other than the base.
  std::vector<Step> steps(const Progress& progress) {
    report(progress, 0, "embedding");
    std::vector<Step> result;
    // First in, first out: from all sides inward.
    for (std::size_t i = 0; i < open_.size(); ++i) {
      poll();
      const int v = open_[i];
      if (state_[v] != State::border || n_chords_[v] > 0) continue;
      Step step{v, below(v)};
      if (step.below.empty()) return result;
      remove(step);
      result.push_back(std::move(step));
    }
    return result;
  }

 private:
  enum class State : char { within, border, just_exposed, removed };  ///< just_exposed: joined the border in this step

  void offer(int v) {
    if (n_chords_[v] == 0 && v != first_ && v != second_) open_.push_back(v);
  }
  /// Whether the edge of two border vertices is a chord.
  bool is_chord(int v, int w) const {
    const bool is_base = (v == first_ && w == second_) || (v == second_ && w == first_);
    const bool is_on_border = state_[w] == State::border || state_[w] == State::just_exposed;
    return is_on_border && left_[v] != w && right_[v] != w && !is_base;
  }
  std::vector<int> below(int v) const {
    std::vector<int> result{left_[v]};
    while (result.back() != right_[v]) {
      const int next = rotations_.next(v, result.back());
      if (next < 0 || state_[next] == State::removed || result.size() > left_.size()) return {};
      result.push_back(next);
    }
    return result;
  }
  void remove(const Step& step) {
    const std::vector<int>& below = step.below;
    state_[step.vertex] = State::removed;
    for (std::size_t i = 0; i + 1 < below.size(); ++i) {
      right_[below[i]] = below[i + 1];
      left_[below[i + 1]] = below[i];
    }
    if (below.size() == 2) {
      // Former chords may now be edges of the border.
      for (const int v : below) {
        --n_chords_[v];
        offer(v);
      }
      return;
    }
    const auto begin = below.begin() + 1;
    const auto end = below.end() - 1;
    for (auto v = begin; v != end; ++v) state_[*v] = State::just_exposed;
    for (auto v = begin; v != end; ++v) {
      rotations_.for_each_neighbor(*v, [&](int w) {
        if (!is_chord(*v, w)) return;
        ++n_chords_[*v];
        if (state_[w] == State::border) ++n_chords_[w];
      });
    }
    for (auto v = begin; v != end; ++v) {
      state_[*v] = State::border;
      offer(*v);
    }
  }

  const Rotations& rotations_;
  int first_;
  int second_;
  std::vector<int> left_;  ///< left neighbor on the border, seen from the base; -1 at its end
  std::vector<int> right_;
  std::vector<int> n_chords_;  ///< of each vertex of the border
  std::vector<State> state_;
  std::vector<int> open_;
};

}  // namespace

ComplexVector grid_embedding(const std::vector<std::array<int, 3>>& triangles, const std::vector<BoundaryLoop>& loops,
                             int outer, int n, const Progress& progress) {
  const BoundaryLoop& loop = loops[static_cast<std::size_t>(outer)];
  if (loop.size() < 3) return {};
  std::vector<std::array<int, 3>> closed = triangles;
  int n_closed = n;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (static_cast<int>(k) == outer || loops[k].size() < 3) continue;
    // The chart lies to the left of its loops, the hole to the right.
    for (std::size_t i = 0; i < loops[k].size(); ++i) {
      closed.push_back({loops[k][(i + 1) % loops[k].size()], loops[k][i], n_closed});
    }
    ++n_closed;
  }
  const Rotations rotations(closed, n_closed);
  if (!rotations.is_simple()) return {};
  std::vector<CanonicalOrder::Step> steps = CanonicalOrder(rotations, loop, n_closed).steps(progress);
  if (static_cast<int>(steps.size()) != n_closed - 2) return {};
  std::reverse(steps.begin(), steps.end());

  // From the base upward. The offset of a border vertex is measured from its left neighbor; that of a covered vertex
  // from the vertex that covers it, or from the neighbor covered together with it.
  std::vector<std::int64_t> offset(static_cast<std::size_t>(n_closed), 0);
  std::vector<std::int64_t> x(offset);
  std::vector<std::int64_t> y(offset);
  for (const auto& [v, below] : steps) {
    const int left = below.front();
    const int right = below.back();
    ++offset[below[1]];
    ++offset[right];
    std::int64_t width = 0;
    for (std::size_t i = 1; i < below.size(); ++i) width += offset[below[i]];
    offset[v] = (width + y[right] - y[left]) / 2;
    y[v] = (width + y[right] + y[left]) / 2;
    offset[right] = width - offset[v];
    if (below.size() > 2) offset[below[1]] -= offset[v];
  }
  // The last border, and then downward the vertices that each vertex covers.
  x[loop[0]] = 0;
  for (std::size_t i = loop.size() - 1; i >= 1; --i) x[loop[i]] = x[loop[(i + 1) % loop.size()]] + offset[loop[i]];
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    int from = step->vertex;
    for (std::size_t i = 1; i + 1 < step->below.size(); ++i) {
      x[step->below[i]] = x[from] + offset[step->below[i]];
      from = step->below[i];
    }
  }
  ComplexVector z(n);
  for (int v = 0; v < n; ++v) z[v] = Complex(static_cast<double>(x[v]), static_cast<double>(y[v]));
  return z;
}

}  // namespace spectral_conformal
