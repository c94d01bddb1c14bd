#include "concurrency/forest_schedule.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numeric>

#include "concurrency/cancellation_scope.h"
#include "concurrency/helper_threads.h"

namespace spectral_conformal {

ForestSchedule ForestSchedule::of(const std::vector<int>& parent, const std::vector<double>& cost) {
  ForestSchedule result;
  const int n = static_cast<int>(parent.size());
  std::vector<double> below = cost;  // of the subtree
  for (int node = 0; node < n; ++node) {
    if (parent[node] >= 0) below[parent[node]] += below[node];
    result.cost_ += cost[node];
  }
  // The node that represents the task: for a cheap subtree its root.
  std::vector<int> head(n);
  std::iota(head.begin(), head.end(), 0);
  for (int node = n - 1; node >= 0; --node) {
    if (parent[node] >= 0 && below[parent[node]] * max_shares <= result.cost_) head[node] = head[parent[node]];
  }
  std::vector<int> task(n);
  for (int node = 0; node < n; ++node) {
    if (head[node] != node) continue;
    task[node] = static_cast<int>(result.below_.size());
    result.below_.push_back(below[node]);
  }
  result.nodes_.resize(result.below_.size());
  result.task_cost_.assign(result.below_.size(), 0);
  for (int node = 0; node < n; ++node) {
    result.nodes_[task[head[node]]].push_back(node);
    result.task_cost_[task[head[node]]] += cost[node];
  }
  result.parent_.assign(result.below_.size(), -1);
  result.children_.resize(result.below_.size());
  result.way_up_ = result.below_;
  for (int node = n - 1; node >= 0; --node) {
    if (head[node] != node || parent[node] < 0) continue;
    const int own = task[node];
    const int above = task[head[parent[node]]];
    result.parent_[own] = above;
    result.children_[above].push_back(own);
    result.way_up_[own] += result.way_up_[above] - result.below_[above] + cost[head[parent[node]]];
  }
  return result;
}

/// One pass through all tasks.
class ForestRun {
 public:
  ForestRun(const ForestSchedule& schedule, bool is_up, const std::function<void(int)>& work, double long_cost)
      : schedule_(schedule), is_up_(is_up), work_(work), long_cost_(long_cost), n_left_(schedule.n_tasks()) {
    ready_.reserve(schedule.parent_.size());
    waits_for_.reserve(schedule.parent_.size());
    for (int task = 0; task < schedule.n_tasks(); ++task) {
      waits_for_.push_back(is_up ? static_cast<int>(schedule.children_[task].size()) : schedule.parent_[task] >= 0);
      if (waits_for_.back() == 0) push(task);
    }
  }

  /// Runs tasks until none is left.
  void run_tasks() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      wait(lock);
      if (n_left_ == 0 || failure_) return;
      const int task = pop();
      lock.unlock();
      std::exception_ptr thrown;
      try {
        run(task);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      --n_left_;
      if (thrown && !failure_) failure_ = thrown;
      if (is_up_) {
        release(schedule_.parent_[task]);
      } else {
        for (const int child : schedule_.children_[task]) release(child);
      }
      // This thread takes one task. Wake the others if there are more, or none left at all.
      if (ready_.size() > 1 || n_left_ == 0 || failure_) changed_.notify_all();
    }
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  /// Waits until there is a task, or none left at all.
  void wait(std::unique_lock<std::mutex>& lock) {
    const auto is_over = [this] { return n_left_ == 0 || failure_; };
    if (!CancellationScope::has_listener()) {
      ++n_waiting_;
      changed_.wait(lock, [&] { return is_over() || !ready_.empty(); });
      --n_waiting_;
      return;
    }
    const auto is_left_to_others = [this] {
      return n_waiting_ > 0 && schedule_.task_cost_[ready_.front()] >= long_cost_;
    };
    if (!is_over() && !ready_.empty() && is_left_to_others()) changed_.notify_one();
    const auto has_news = [&] { return is_over() || (!ready_.empty() && !is_left_to_others()); };
    while (!changed_.wait_for(lock, CancellationScope::interval, has_news)) {
      lock.unlock();
      std::exception_ptr thrown;
      try {
        CancellationScope::ask();
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      if (thrown && !failure_) failure_ = thrown;
      if (thrown) changed_.notify_all();
    }
  }
  void run(int task) const {
    const std::vector<int>& nodes = schedule_.nodes_[task];
    if (is_up_) {
      for (const int node : nodes) work_(node);
    } else {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) work_(*node);
    }
  }
  void release(int task) {
    if (task >= 0 && --waits_for_[task] == 0) push(task);
  }
  bool comes_after(int a, int b) const {
    const std::vector<double>& way = is_up_ ? schedule_.way_up_ : schedule_.below_;
    return way[a] != way[b] ? way[a] < way[b] : a > b;
  }
  void push(int task) {
    ready_.push_back(task);
    std::push_heap(ready_.begin(), ready_.end(), [this](int a, int b) { return comes_after(a, b); });
  }
  int pop() {
    std::pop_heap(ready_.begin(), ready_.end(), [this](int a, int b) { return comes_after(a, b); });
    const int task = ready_.back();
    ready_.pop_back();
    return task;
  }

  const ForestSchedule& schedule_;
  bool is_up_;
  const std::function<void(int)>& work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<int> waits_for_;
  std::vector<int> ready_;  ///< a heap
  double long_cost_;
  int n_left_;
  int n_waiting_ = 0;  ///< threads without a listener
  std::exception_ptr failure_;
};

void ForestSchedule::run_up(unsigned threads, const std::function<void(int)>& work, double long_cost) const {
  run(true, threads, work, long_cost);
}

void ForestSchedule::run_down(unsigned threads, const std::function<void(int)>& work) const {
  run(false, threads, work, std::numeric_limits<double>::infinity());
}

void ForestSchedule::run(bool is_up, unsigned threads, const std::function<void(int)>& work, double long_cost) const {
  if (n_tasks() == 0) return;
  ForestRun all(*this, is_up, work, long_cost);
  {
    const HelperThreads helpers(std::min(threads, static_cast<unsigned>(n_tasks())) - 1, [&all] { all.run_tasks(); });
    all.run_tasks();
  }
  CancellationScope::rethrow();
  all.rethrow();
}

}  // namespace spectral_conformal
