#include "graph/helper_threads.h"

#include <new>
#include <system_error>

namespace spectral_conformal {

HelperThreads::HelperThreads(unsigned count, const std::function<void()>& work) {
  try {
    threads_.reserve(count);
    while (threads_.size() < count) threads_.emplace_back(work);
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
