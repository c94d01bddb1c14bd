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
  /// How often the listener is asked, in work or time. A Python listener waits up to 5 ms for the interpreter lock
  /// while another thread is busy.
  static constexpr std::chrono::duration<double, std::nano> interval{40e6};

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
  friend void poll(double nanoseconds);
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

/// For tests: sets the interval of work, in nanoseconds, for threads that begin to listen from now on; they then ignore
/// the clock. Returns the previous interval; 0 means the default.
double exchange_poll_interval(double nanoseconds);
/// The interval in use.
double poll_interval();
/// For tests: the most work, in nanoseconds, that this thread reported between two calls of a listener. Resets it.
double take_longest_silence();

/// Reports about how long this thread has worked since its last report. The listener is asked after each
/// CancellationScope::interval of such work, or earlier if the clock says so: the first use of new memory, above all,
/// may take many times as long. Cheap. Throws as CancellationScope::ask does, so call it where nothing is half done.
void poll(double nanoseconds);

/// The one rule for sharing work: a thread is started only for at least this much work, twenty times the cost of
/// starting it. Blocks of work of this size are reported at once.
constexpr double shared_nanoseconds = 1e6;

/// Enough shares of large work for sixteen threads to finish at about the same time.
constexpr int max_shares = 64;

/// Calls work(i) once for every i from 0 to n - 1, in this order. nanoseconds: the approximate time of each call,
/// reported between blocks of calls. Throws as poll does.
template <class Index, class Work>
void for_each_polled(Index n, double nanoseconds, const Work& work) {
  const auto at_once = static_cast<Index>(std::max(1.0, shared_nanoseconds / nanoseconds));
  for (Index begin = 0; begin < n;) {
    const Index end = begin + std::min<Index>(at_once, n - begin);
    for (Index i = begin; i < end; ++i) work(i);
    poll(nanoseconds * static_cast<double>(end - begin));
    begin = end;
  }
}

/// Approximate time to compute a few numbers of a triangle or an edge. It only determines how often a listener is asked
/// and how small work is not shared, so a factor of two does not matter.
constexpr double element_nanoseconds = 50;

/// The same for such elements.
template <class Index, class Work>
void for_each_polled(Index n, const Work& work) {
  for_each_polled(n, element_nanoseconds, work);
}

/// Copies large elements, reporting likewise.
template <class T>
std::vector<T> polled_copy(const std::vector<T>& elements) {
  std::vector<T> result;
  result.reserve(elements.size());
  for_each_polled(elements.size(), 0.25 * sizeof(T), [&](std::size_t i) { result.push_back(elements[i]); });
  return result;
}

}  // namespace spectral_conformal
