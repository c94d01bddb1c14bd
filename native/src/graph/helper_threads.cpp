#include "graph/helper_threads.h"

#include <new>
#include <system_error>

#include "graph/work_counter.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal {

HelperThreads::HelperThreads(unsigned count, const std::function<void()>& work) {
  try {
    const auto limited = [work, limit = ThreadLimit::current(), counter = WorkCounter::current()] {
      const ThreadLimit of_caller(limit);
      const WorkCounter::Share with_caller(counter);
      work();
    };
    threads_.reserve(count);
    while (threads_.size() < count) threads_.emplace_back(limited);
  } catch (const std::system_error&) {
    return;  // no more threads
  } catch (const std::bad_alloc&) {
    return;
  }
}

HelperThreads::~HelperThreads() {
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace spectral_conformal
