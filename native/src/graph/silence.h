#pragma once

#include <atomic>
#include <chrono>
#include <utility>

#include "graph/listening.h"

namespace spectral_conformal {

/// For tests: the interval of work that exchange_listening_interval has set, in nanoseconds; 0 for the usual one.
inline std::atomic<double>& listening_interval_of_test() {
  static std::atomic<double> interval{0};
  return interval;
}

/// The work, in nanoseconds, after which a listener is asked.
inline double listening_interval() {
  const double of_test = listening_interval_of_test();
  return of_test > 0 ? of_test : std::chrono::nanoseconds(Listening::interval).count();
}

/// The most work, in nanoseconds, that this thread has said it did between two calls of a listener.
inline double& longest_silence() {
  thread_local double nanoseconds = 0;
  return nanoseconds;
}

/// For tests. Begins anew.
inline double take_longest_silence() { return std::exchange(longest_silence(), 0.0); }

}  // namespace spectral_conformal
