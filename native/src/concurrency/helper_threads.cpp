#include "concurrency/helper_threads.h"

#include <exception>

#include "concurrency/cancellation_scope.h"
#include "concurrency/work_counter.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal {

HelperThreads::HelperThreads(unsigned count, const std::function<void()>& work) : share_(count) {
  if (share_.size() == 0) return;
  try {
    const auto as_caller = [this, work, limit = ThreadLimit::current(), counter = WorkCounter::current(),
                            scope = CancellationScope::current()] {
      // The C++ library allocates a thread's exception memory at the first throw. If that throw is due to a lack of
      // memory, the C library ends the process. So allocate it here.
      static_cast<void>(std::current_exception());
      const ThreadBudget::Share::Member member(share_);
      const ThreadLimit of_caller(limit);
      const WorkCounter::Share with_caller(counter);
      const CancellationScope::Joined joined(scope);
      work();
    };
    threads_.reserve(share_.size());
    while (threads_.size() < share_.size()) threads_.emplace_back(as_caller);
  } catch (const std::exception&) {  // the system or the memory allows no more
    share_.shrink(static_cast<unsigned>(threads_.size()));
  }
}

HelperThreads::~HelperThreads() {
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace spectral_conformal
