#include "spectral_conformal/thread_limit.h"

#include "concurrency/thread_budget.h"

namespace spectral_conformal {
namespace {

/// Per thread, so that no call depends on another thread.
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

unsigned ThreadLimit::available() { return ThreadBudget::available(); }

}  // namespace spectral_conformal
