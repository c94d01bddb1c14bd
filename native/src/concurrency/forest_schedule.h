#pragma once

#include <functional>
#include <limits>
#include <vector>

namespace spectral_conformal {

/// The order in which several threads traverse a forest, from the leaves to the roots or back: cheap subtrees as a
/// whole, the nodes above them one by one, most expensive path to the root first. Idle threads sleep.
class ForestSchedule {
 public:
  /// parent: (n,), greater than the node, -1 for a root. cost: (n,), per node, nonnegative, in any unit.
  static ForestSchedule of(const std::vector<int>& parent, const std::vector<double>& cost);

  /// Calls work(node) for every node, after all of its children, in up to `threads` threads including the caller's, or
  /// fewer if the system has no more. Later calls see what earlier ones wrote. After a call throws, no other subtree
  /// begins; once all have ended, the exception is rethrown. While the caller's thread is idle, it asks its
  /// CancellationScope; it leaves tasks of long_cost or more to other idle threads.
  void run_up(unsigned threads, const std::function<void(int node)>& work,
              double long_cost = std::numeric_limits<double>::infinity()) const;
  /// The same, with each node after its parent.
  void run_down(unsigned threads, const std::function<void(int node)>& work) const;

  double cost() const { return cost_; }  ///< of all nodes

 private:
  friend class ForestRun;
  void run(bool is_up, unsigned threads, const std::function<void(int)>& work, double long_cost) const;
  int n_tasks() const { return static_cast<int>(parent_.size()); }

  double cost_ = 0;
  std::vector<std::vector<int>> nodes_;     ///< of each task, ascending
  std::vector<int> parent_;                 ///< of each task, a task or -1
  std::vector<std::vector<int>> children_;  ///< of each task, tasks
  std::vector<double> way_up_;              ///< cost of a task, of all below it and of its path to the root
  std::vector<double> below_;               ///< cost of a task and of all below it
  std::vector<double> task_cost_;
};

}  // namespace spectral_conformal
