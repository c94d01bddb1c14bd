#include "concurrency/parallel_calls.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "concurrency/helper_threads.h"

namespace spectral_conformal {
namespace {

/// The remaining calls, and the outcome of the others.
class SharedCalls {
 public:
  SharedCalls(int n, const std::function<void(int, const Progress&)>& work)
      : work_(work), n_(n), failures_(static_cast<std::size_t>(n)) {}

  /// Makes calls until none is left.
  void make_calls(const Progress& progress) {
    while (!has_failed_ && !canceled_) {
      const int i = next_++;
      if (i >= n_) return;
      try {
        work_(i, progress);
      } catch (...) {
        failures_[static_cast<std::size_t>(i)] = std::current_exception();
        has_failed_ = true;
        if (CancellationScope::is_canceled()) cancel();
      }
    }
  }
  bool is_canceled() const { return canceled_; }
  void cancel() { canceled_ = true; }
  /// Calls begin in order and always finish, so all calls before a failed one were made.
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
  std::atomic<bool> canceled_{false};  ///< running calls see a cancellation, but not a failure
};

/// Threads that make calls until none is left.
class Helpers {
 public:
  Helpers(unsigned count, SharedCalls& calls) : calls_(calls), threads_(count, [this] { run(); }) {}

  bool empty() const { return threads_.size() == 0; }
  [[nodiscard]] ThreadBudget::Share::Waiting waiting() { return threads_.wait(); }
  /// True when all are done, false after the interval.
  bool wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    return ended_.wait_for(lock, CancellationScope::interval, [this] { return n_ended_ == threads_.size(); });
  }

 private:
  void run() {
    calls_.make_calls([this](double, const char*) { return !calls_.is_canceled(); });
    const std::lock_guard<std::mutex> lock(mutex_);
    ++n_ended_;
    ended_.notify_one();
  }

  SharedCalls& calls_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t n_ended_ = 0;
  HelperThreads threads_;  ///< last: they use the members above
};

}  // namespace

void run_in_parallel(int n, const std::function<void(int, const Progress&)>& work, const Progress& progress,
                     const char* phase_of_waiting, unsigned max_threads) {
  if (n <= 0) return;
  SharedCalls calls(n, work);
  std::exception_ptr thrown;
  double done = 0;
  const auto ask = [&](const char* phase) {
    if (calls.is_canceled()) return false;
    try {
      if (!phase) {
        CancellationScope::ask();
      } else if (progress && !progress(done, phase)) {
        calls.cancel();
      }
    } catch (...) {
      thrown = std::current_exception();
      calls.cancel();
    }
    return !calls.is_canceled();
  };
  const Progress asking = [&](double fraction, const char* phase) {
    done = std::max(done, fraction);
    return ask(phase);
  };
  {
    Helpers helpers(std::min(max_threads, static_cast<unsigned>(n)) - 1, calls);
    calls.make_calls(asking);
    const auto waiting = helpers.waiting();
    while (!helpers.wait()) ask(progress ? phase_of_waiting : nullptr);
  }
  if (thrown) std::rethrow_exception(thrown);
  CancellationScope::rethrow();
  if (calls.is_canceled()) throw Cancelled();
  calls.rethrow_first();
}

void call_while_polling(std::size_t steps, const std::function<void()>& call) {
  if (!CancellationScope::has_listener() || steps < max_unpolled_steps()) {
    call();
    poll(steps);
    return;
  }
  const std::function<void(int, const Progress&)> work = [&call](int, const Progress&) { call(); };
  SharedCalls calls(1, work);
  {
    Helpers helpers(1, calls);
    if (helpers.empty()) calls.make_calls({});
    const auto waiting = helpers.waiting();
    while (!helpers.wait()) {
      try {
        CancellationScope::ask();
      } catch (...) {
        // Thrown again below.
      }
    }
  }
  CancellationScope::rethrow();
  calls.rethrow_first();
}

}  // namespace spectral_conformal
