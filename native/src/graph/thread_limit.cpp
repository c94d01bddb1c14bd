#include "spectral_conformal/thread_limit.h"

#include <algorithm>
#include <thread>

namespace spectral_conformal {
namespace {

/// Each thread sees its own only, so that no call depends on what another thread does.
thread_local unsigned limit_of_thread = 0;

}  // namespace

ThreadLimit::ThreadLimit(unsigned limit) : before_(exchange(limit)) {}

ThreadLimit::~ThreadLimit() { exchange(before_); }

unsigned ThreadLimit::current() { return limit_of_thread; }

unsigned ThreadLimit::exchange(unsigned limit) {
  const unsigned before = limit_of_thread;
  limit_of_thread = limit;
  return before;
}

unsigned ThreadLimit::available() {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  return limit_of_thread == 0 ? cores : std::min(limit_of_thread, cores);
}

}  // namespace spectral_conformal
