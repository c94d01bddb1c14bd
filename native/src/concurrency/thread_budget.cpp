#include "concurrency/thread_budget.h"

#include <algorithm>
#include <mutex>
#include <thread>

#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal {
namespace {

struct Process {
  std::mutex mutex;  ///< guards the following, and the helper counts in shares
  int n_callers = 0;
  int n_helpers = 0;  ///< at work, less the owners that wait for them
  std::atomic<unsigned> pretended_cores{0};
};

Process& of_process() {
  static Process all;
  return all;
}

thread_local ThreadBudget::Share* share_of_thread = nullptr;

unsigned rest_of(unsigned of, int used) { return static_cast<unsigned>(std::max(0, static_cast<int>(of) - used)); }

}  // namespace

unsigned ThreadBudget::exchange_cores(unsigned cores) { return of_process().pretended_cores.exchange(cores); }

unsigned ThreadBudget::cores() {
  const unsigned pretended = of_process().pretended_cores;
  return pretended > 0 ? pretended : std::max(1U, std::thread::hardware_concurrency());
}

unsigned ThreadBudget::n_helpers() {
  const std::lock_guard<std::mutex> lock(of_process().mutex);
  return static_cast<unsigned>(std::max(0, of_process().n_helpers));
}

unsigned ThreadBudget::available() {
  const unsigned part = share_of_thread ? share_of_thread->each() : cores();
  const unsigned limit = ThreadLimit::current();
  return limit == 0 ? part : std::min(limit, part);
}

unsigned ThreadBudget::Share::each() const { return std::max(1U, total_ / std::max(1U, at_work_.load())); }

ThreadBudget::Share::Share(unsigned wanted) {
  if (wanted == 0) return;
  Process& all = of_process();
  const std::lock_guard<std::mutex> lock(all.mutex);
  outer_ = share_of_thread;
  caller_ = outer_ ? outer_->caller_ : this;
  total_ = available();
  if (!outer_) total_ = std::min(total_, std::max(1U, cores() / static_cast<unsigned>(++all.n_callers)));
  // A share gets at most its part, less what others hold of the caller's part or of the process's cores.
  size_ = std::min({wanted, rest_of(total_, 1), rest_of(caller_->total_, 1 + caller_->n_of_caller_),
                    rest_of(cores(), all.n_callers + all.n_helpers)});
  all.n_helpers += static_cast<int>(size_);
  caller_->n_of_caller_ += static_cast<int>(size_);
  at_work_ = 1 + size_;
  share_of_thread = this;
}

ThreadBudget::Share::~Share() {
  if (!caller_) return;
  share_of_thread = outer_;
  give_back(size_ - n_left_);
  if (outer_) return;
  const std::lock_guard<std::mutex> lock(of_process().mutex);
  --of_process().n_callers;
}

void ThreadBudget::Share::shrink(unsigned size) {
  if (size >= size_) return;
  at_work_ -= size_ - size;
  give_back(size_ - size);
}

void ThreadBudget::Share::give_back(unsigned n) {
  const std::lock_guard<std::mutex> lock(of_process().mutex);
  of_process().n_helpers -= static_cast<int>(n);
  caller_->n_of_caller_ -= static_cast<int>(n);
  size_ -= n;
}

void ThreadBudget::Share::leave() {
  if (!caller_) return;
  const std::lock_guard<std::mutex> lock(of_process().mutex);
  --of_process().n_helpers;
  --caller_->n_of_caller_;
  --at_work_;
  ++n_left_;
}

void ThreadBudget::Share::rejoin() {
  if (!caller_) return;
  const std::lock_guard<std::mutex> lock(of_process().mutex);
  ++of_process().n_helpers;
  ++caller_->n_of_caller_;
  ++at_work_;
  --n_left_;
}

ThreadBudget::Share::Member::Member(Share& share) : share_(share) { share_of_thread = &share; }

ThreadBudget::Share::Member::~Member() {
  share_of_thread = nullptr;
  share_.leave();
}

}  // namespace spectral_conformal
