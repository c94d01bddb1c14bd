#include "graph/vertex_separator.h"

#include <algorithm>
#include <cstddef>

#include "concurrency/cancellation_scope.h"

namespace spectral_conformal {
namespace {

/// Stands for the node before the first and after the last of a path.
constexpr int terminal = -2;

/// Paths from sources to sinks that have no node in common. The residual network has two states of each node, entered
/// and left, and capacity 1 from one to the other.
class DisjointPaths {
 public:
  DisjointPaths(const Adjacency& graph, const std::vector<char>& is_source, const std::vector<char>& is_sink)
      : graph_(graph),
        is_source_(is_source),
        is_sink_(is_sink),
        next_(is_source.size(), no_index),
        previous_(is_source.size(), no_index),
        level_(2 * is_source.size()),
        tried_(2 * is_source.size()) {}

  /// As many as there are.
  void find() {
    while (find_levels()) {
      std::fill(tried_.begin(), tried_.end(), 0);
      for (int node = 0; node < graph_.n_nodes(); ++node) {
        if (is_source_[node] && previous_[node] != terminal && find_path(entered(node))) take_path();
      }
    }
  }

  /// Whether the residual network has a path to the node.
  bool reaches(int node) const { return level_[entered(node)] >= 0; }
  bool passes(int node) const { return level_[left(node)] >= 0; }

 private:
  static int entered(int node) { return 2 * node; }
  static int left(int node) { return 2 * node + 1; }
  static int node_of(int state) { return state / 2; }
  static bool is_left(int state) { return state % 2 != 0; }

  int n_moves(int state) const {
    if (!is_left(state)) return 1;
    return 1 + graph_.first_arc(node_of(state) + 1) - graph_.first_arc(node_of(state));
  }
  /// The state that the k-th move leads to, or no_index.
  int move(int state, int k) const {
    const int node = node_of(state);
    const int previous = previous_[node];
    if (!is_left(state)) {
      if (previous == terminal) return no_index;
      return left(previous == no_index ? node : previous);  // cancels the flow from there
    }
    if (k > 0) return entered(graph_.arc(graph_.first_arc(node) + k - 1).to);
    return previous == no_index ? no_index : entered(node);  // reroutes the path
  }
  bool is_end(int state) const {
    return is_left(state) && is_sink_[node_of(state)] && next_[node_of(state)] != terminal;
  }

  /// Numbers the states by their distance from the sources, up to the nearest end. Returns false if no end is reached.
  bool find_levels() {
    std::fill(level_.begin(), level_.end(), no_index);
    queue_.clear();
    last_level_ = no_index;
    for (int node = 0; node < graph_.n_nodes(); ++node) {
      if (!is_source_[node]) continue;
      level_[entered(node)] = 0;
      queue_.push_back(entered(node));
    }
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const int state = queue_[i];
      poll();
      if (last_level_ != no_index && level_[state] >= last_level_) break;
      if (is_end(state)) last_level_ = level_[state];
      for (int k = 0; k < n_moves(state); ++k) {
        const int to = move(state, k);
        if (to == no_index || level_[to] != no_index) continue;
        level_[to] = level_[state] + 1;
        queue_.push_back(to);
      }
    }
    return last_level_ != no_index;
  }

  bool find_path(int start) {
    path_.assign(1, start);
    while (!path_.empty()) {
      const int state = path_.back();
      poll();
      if (level_[state] == last_level_ && is_end(state)) return true;
      int to = no_index;
      while (to == no_index && tried_[state] < n_moves(state)) {
        to = move(state, tried_[state]++);
        if (to != no_index && level_[to] != level_[state] + 1) to = no_index;
      }
      if (to != no_index) {
        path_.push_back(to);
      } else {
        level_[state] = no_index;
        path_.pop_back();
      }
    }
    return false;
  }

  void take_path() {
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
      const int node = node_of(path_[i]);
      if (is_left(path_[i]) || node_of(path_[i + 1]) == node) continue;
      next_[node_of(path_[i + 1])] = no_index;
      previous_[node] = no_index;
    }
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
      const int node = node_of(path_[i]);
      const int to = node_of(path_[i + 1]);
      if (!is_left(path_[i]) || to == node) continue;
      next_[node] = to;
      previous_[to] = node;
    }
    previous_[node_of(path_.front())] = terminal;
    next_[node_of(path_.back())] = terminal;
    for (const int state : path_) level_[state] = no_index;
  }

  const Adjacency& graph_;
  const std::vector<char>& is_source_;
  const std::vector<char>& is_sink_;
  std::vector<int> next_;      ///< of each node on a path
  std::vector<int> previous_;  ///< the same
  std::vector<int> level_;     ///< of each state
  std::vector<int> tried_;     ///< moves of each state
  std::vector<int> queue_;
  std::vector<int> path_;  ///< states
  int last_level_ = no_index;
};

}  // namespace

std::vector<SeparatorSide> smallest_vertex_separator(const Adjacency& graph, const std::vector<char>& is_source,
                                                     const std::vector<char>& is_sink) {
  DisjointPaths paths(graph, is_source, is_sink);
  paths.find();
  std::vector<SeparatorSide> side;
  side.reserve(is_source.size());
  for (int node = 0; node < graph.n_nodes(); ++node) {
    if (paths.passes(node)) {
      side.push_back(SeparatorSide::source);
    } else {
      side.push_back(paths.reaches(node) ? SeparatorSide::separator : SeparatorSide::sink);
    }
  }
  return side;
}

}  // namespace spectral_conformal
