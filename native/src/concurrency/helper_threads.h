#pragma once

#include <functional>
#include <thread>
#include <vector>

#include "concurrency/thread_budget.h"

namespace spectral_conformal {

/// Threads beside the caller's that all do the same work, with the caller's ThreadLimit and WorkCounter; the destructor
/// joins them. There may be fewer, or none, if the ThreadBudget, the system or the memory allows no more: the caller
/// must be able to do all of the work.
class HelperThreads {
 public:
  /// `work` must not throw.
  HelperThreads(unsigned count, const std::function<void()>& work);
  ~HelperThreads();
  HelperThreads(const HelperThreads&) = delete;
  HelperThreads& operator=(const HelperThreads&) = delete;

  std::size_t size() const { return threads_.size(); }
  /// While the caller keeps it, its part of the ThreadBudget is the helpers'.
  [[nodiscard]] ThreadBudget::Share::Waiting wait() { return ThreadBudget::Share::Waiting(share_); }

 private:
  ThreadBudget::Share share_;
  std::vector<std::thread> threads_;
};

}  // namespace spectral_conformal
