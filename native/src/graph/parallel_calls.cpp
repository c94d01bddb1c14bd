#include "graph/parallel_calls.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <vector>

#include "graph/helper_threads.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal {
namespace {

/// How often the caller is asked whether to go on, while its thread has nothing left to do.
constexpr std::chrono::milliseconds poll_interval{30};

/// The calls that are left, and what became of the others.
class SharedCalls {
 public:
  SharedCalls(int n, const std::function<void(int, const Progress&)>& work)
      : work_(work), n_(n), failures_(static_cast<std::size_t>(n)) {}

  void take(const Progress& progress) {
    while (!has_failed_ && !cancelled_) {
      const int i = next_++;
      if (i >= n_) return;
      try {
        work_(i, progress);
      } catch (...) {
        failures_[static_cast<std::size_t>(i)] = std::current_exception();
        has_failed_ = true;
      }
    }
  }
  bool is_cancelled() const { return cancelled_; }
  void cancel() { cancelled_ = true; }
  /// Calls begin in their order, and none that has begun is left out: those before a failed one all were made.
  void rethrow_first() const {
    for (const std::exception_ptr& failure : failures_) {
      if (failure) std::rethrow_exception(failure);
    }
  }

 private:
  const std::function<void(int, const Progress&)>& work_;
  int n_;
  std::vector<std::exception_ptr> failures_;
  std::atomic<int> next_{0};
  std::atomic<bool> has_failed_{false};
  std::atomic<bool> cancelled_{false};  ///< calls that go on hear of it; of failures they do not
};

/// Threads that take calls until none is left.
class Helpers {
 public:
  Helpers(unsigned count, SharedCalls& calls) : calls_(calls), threads_(count, [this] { run(); }) {}

  /// True when all are done, false after the interval.
  bool wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    return ended_.wait_for(lock, poll_interval, [this] { return n_ended_ == threads_.size(); });
  }

 private:
  void run() {
    calls_.take([this](double, const char*) { return !calls_.is_cancelled(); });
    const std::lock_guard<std::mutex> lock(mutex_);
    ++n_ended_;
    ended_.notify_one();
  }

  SharedCalls& calls_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t n_ended_ = 0;
  HelperThreads threads_;  ///< last: they use what stands above
};

}  // namespace

void run_in_parallel(int n, unsigned max_threads, const std::function<void(int, const Progress&)>& work,
                     const Progress& progress, const char* phase_of_waiting) {
  if (n <= 0) return;
  SharedCalls calls(n, work);
  std::exception_ptr thrown;
  double done = 0;
  const Progress asking = [&](double fraction, const char* phase) {
    if (!progress || calls.is_cancelled()) return !calls.is_cancelled();
    done = std::max(done, fraction);
    try {
      if (!progress(done, phase)) calls.cancel();
    } catch (...) {
      thrown = std::current_exception();
      calls.cancel();
    }
    return !calls.is_cancelled();
  };
  {
    const unsigned threads = std::min({max_threads, ThreadLimit::available(), unsigned(n)});
    // A limit is divided among the threads, whose work may share its own calls; cores without one are not.
    const unsigned limit = ThreadLimit::current();
    const ThreadLimit of_each(limit == 0 ? 0 : std::max(1U, limit / threads));
    Helpers helpers(threads - 1, calls);
    calls.take(asking);
    while (!helpers.wait()) asking(done, phase_of_waiting);
  }
  if (thrown) std::rethrow_exception(thrown);
  if (calls.is_cancelled()) throw Cancelled();
  calls.rethrow_first();
}

}  // namespace spectral_conformal
