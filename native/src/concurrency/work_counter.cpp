#include "concurrency/work_counter.h"

#include <utility>

namespace spectral_conformal {
namespace {

thread_local WorkCounter* counter_of_thread = nullptr;

std::uint64_t whole(double amount) { return static_cast<std::uint64_t>(amount); }

void count(const WorkCounts& more) {
  if (counter_of_thread) counter_of_thread->add(more);
}

}  // namespace

WorkCounter::Share::Share(WorkCounter* counter) : before_(std::exchange(counter_of_thread, counter)) {}

WorkCounter::Share::~Share() { counter_of_thread = before_; }

WorkCounter* WorkCounter::current() { return counter_of_thread; }

WorkCounts WorkCounter::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

void WorkCounter::add(const WorkCounts& more) {
  const std::lock_guard<std::mutex> lock(mutex_);
  counts_.analyses += more.analyses;
  counts_.factorizations += more.factorizations;
  counts_.solves += more.solves;
  counts_.multiplications += more.multiplications;
  counts_.solve_doubles += more.solve_doubles;
  counts_.steps += more.steps;
}

void count_analysis() { count({1, 0, 0, 0, 0, 0}); }
void count_factorization(double multiplications) { count({0, 1, 0, whole(multiplications), 0, 0}); }
void count_solve(double doubles) { count({0, 0, 1, 0, whole(doubles), 0}); }
void count_steps(double steps) { count({0, 0, 0, 0, 0, whole(steps)}); }

}  // namespace spectral_conformal
