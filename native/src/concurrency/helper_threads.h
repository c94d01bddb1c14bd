#pragma once

#include <functional>
#include <thread>
#include <vector>

#include "concurrency/thread_budget.h"

namespace spectral_conformal {

/// Threads beside the caller's, under its ThreadLimit and WorkCounter, that all do the same work; joined when the
/// object ends. Fewer, or none, where the ThreadBudget or the system has no more threads, or no memory for them: the
/// work must be such that the caller can do all of it.
class HelperThreads {
 public:
  /// `work` must not throw.
  HelperThreads(unsigned count, const std::function<void()>& work);
  ~HelperThreads();
  HelperThreads(const HelperThreads&) = delete;
  HelperThreads& operator=(const HelperThreads&) = delete;

  std::size_t size() const { return threads_.size(); }

 private:
  ThreadBudget::Share share_;
  std::vector<std::thread> threads_;
};

}  // namespace spectral_conformal
