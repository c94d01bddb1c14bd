#include "concurrency/work_counter.h"

#include <utility>

namespace spectral_conformal {
namespace {

thread_local WorkCounter* counter_of_thread = nullptr;

}  // namespace

WorkCounter::Share::Share(WorkCounter* counter) : before_(std::exchange(counter_of_thread, counter)) {}

WorkCounter::Share::~Share() { counter_of_thread = before_; }

WorkCounter::WorkCounter() : share_(this) {}

WorkCounter::~WorkCounter() = default;

WorkCounter* WorkCounter::current() { return counter_of_thread; }

WorkCounts WorkCounter::counts() const {
  return {analyses_, factorizations_, solves_, multiplications_, solve_doubles_, steps_};
}

void WorkCounter::add(std::atomic<std::uint64_t>& sum, double value) {
  sum.fetch_add(static_cast<std::uint64_t>(value), std::memory_order_relaxed);
}

void WorkCounter::add_factorization(double multiplications) {
  add(factorizations_, 1);
  add(multiplications_, multiplications);
}

void WorkCounter::add_solve(double doubles) {
  add(solves_, 1);
  add(solve_doubles_, doubles);
}

void count_analysis() {
  if (WorkCounter* const counter = WorkCounter::current()) counter->add_analysis();
}

void count_factorization(double multiplications) {
  if (WorkCounter* const counter = WorkCounter::current()) counter->add_factorization(multiplications);
}

void count_solve(double doubles) {
  if (WorkCounter* const counter = WorkCounter::current()) counter->add_solve(doubles);
}

void count_steps(double steps) {
  if (WorkCounter* const counter = WorkCounter::current()) counter->add_steps(steps);
}

}  // namespace spectral_conformal
