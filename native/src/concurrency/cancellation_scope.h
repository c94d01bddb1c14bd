#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <vector>

#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// While it lives, a progress function can cancel long work of the creating thread even where the work reports no
/// progress: `poll` repeats the last report, and threads that work for this one see the cancellation there. An
/// inner object replaces the outer one.
class CancellationScope {
 public:
  /// How often the listener is asked. A Python listener waits up to 5 ms for the interpreter lock while another thread
  /// is busy.
  static constexpr std::chrono::milliseconds interval{40};

  /// progress: must outlive the object; if empty, nothing changes. phase: reported with fraction 0 until the first
  /// report.
  CancellationScope(const Progress& progress, const char* phase);
  ~CancellationScope();
  CancellationScope(const CancellationScope&) = delete;
  CancellationScope& operator=(const CancellationScope&) = delete;

  /// Report to this function instead of the given one.
  const Progress& progress() const { return reporting_; }

  /// Asks the listener of this thread now, if it has one. Throws Cancelled, or what the listener throws.
  static void ask();
  /// Whether this thread has a listener of its own.
  static bool has_listener();
  /// Whether the listener of this thread, or of the thread that it works for, has canceled the work.
  static bool is_canceled();
  /// If the listener of this thread ended the work, throws the reason.
  static void rethrow();
  /// The listener of this thread, or of the thread that it works for; null for none.
  static CancellationScope* current();

  /// While it lives, the calling thread sees the cancellation of another.
  class Joined {
   public:
    explicit Joined(CancellationScope* scope);
    ~Joined();
    Joined(const Joined&) = delete;
    Joined& operator=(const Joined&) = delete;

   private:
    CancellationScope* before_;
  };

 private:
  friend void poll(std::size_t steps);
  bool forward(double fraction, const char* phase);
  void rethrow_own() const;

  const Progress* given_;
  Progress reporting_;
  CancellationScope* before_ = nullptr;
  double fraction_ = 0;
  const char* phase_;
  std::atomic<bool> is_canceled_{false};
  std::exception_ptr thrown_;  ///< by the listener
};

/// For tests: the listener of a thread that begins to listen from now on is asked after this many steps, whatever the
/// clock says. Returns the previous number; 0 means by the clock.
std::size_t exchange_poll_interval(std::size_t steps);
/// The number of steps that may pass without a poll: some take a microsecond.
std::size_t max_unpolled_steps();

/// Counts steps of work: visits of an element, above all. After as many as take about a millisecond, and at most a few
/// thousand, the thread looks at the clock, and if CancellationScope::interval has passed, asks its listener, or sees
/// whether the thread that it works for was canceled. Cheap. Throws as CancellationScope::ask does, so call it where
/// nothing is half done.
void poll(std::size_t steps = 1);
/// The steps before this thread looks at the clock again, at least 1.
std::size_t steps_before_look();

/// The one rule for sharing work: a thread is started only for at least this many steps, which take twenty times as
/// long as starting it.
constexpr std::size_t shared_steps = 20'000;

/// Enough shares of large work for sixteen threads to finish at about the same time.
constexpr int max_shares = 64;

/// Calls work(i) once for every i from 0 to n - 1, in this order, and polls: each call is a step. Throws as poll does.
template <class Index, class Work>
void for_each_polled(Index n, const Work& work) {
  for (Index i = 0; i < n;) {
    const std::size_t steps = std::min(steps_before_look(), static_cast<std::size_t>(n - i));
    for (const Index end = i + static_cast<Index>(steps); i < end; ++i) work(i);
    poll(steps);
  }
}

/// Copies many elements, polling likewise.
template <class T>
std::vector<T> polled_copy(const std::vector<T>& elements) {
  std::vector<T> result;
  result.reserve(elements.size());
  for_each_polled(elements.size(), [&](std::size_t i) { result.push_back(elements[i]); });
  return result;
}

}  // namespace spectral_conformal
