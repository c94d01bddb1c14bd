#include "concurrency/cancellation_scope.h"

#include <utility>

namespace spectral_conformal {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<double> interval_of_test{0};  ///< of work, in nanoseconds; 0 for none

struct PollState {
  CancellationScope* own = nullptr;
  CancellationScope* other = nullptr;  ///< of the thread that this one works for
  // Since the listener was last asked:
  double worked = 0;
  double next_look = 0;  ///< at the clock, when this much work is done
  Clock::time_point asked;
  double longest_silence = 0;  ///< of work

  void begin_interval() {
    longest_silence = std::max(longest_silence, worked);
    worked = 0;
    const double interval = interval_of_test;
    next_look = interval > 0 ? interval : shared_nanoseconds;
    if (!(interval > 0)) asked = Clock::now();
  }
  bool is_due() const {
    return interval_of_test > 0 || worked >= CancellationScope::interval.count() ||
           Clock::now() - asked >= CancellationScope::interval;
  }
};

thread_local PollState state;

}  // namespace

double exchange_poll_interval(double nanoseconds) { return interval_of_test.exchange(nanoseconds); }

double poll_interval() {
  const double interval = interval_of_test;
  return interval > 0 ? interval : CancellationScope::interval.count();
}

double take_longest_silence() { return std::exchange(state.longest_silence, 0.0); }

CancellationScope::CancellationScope(const Progress& progress, const char* phase) : given_(&progress), phase_(phase) {
  if (!progress) return;
  reporting_ = [this](double fraction, const char* phase) { return forward(fraction, phase); };
  before_ = std::exchange(state.own, this);
  state.begin_interval();
}

CancellationScope::~CancellationScope() {
  if (reporting_) state.own = before_;
}

bool CancellationScope::forward(double fraction, const char* phase) {
  fraction_ = fraction;
  phase_ = phase;
  if (is_canceled_) return false;
  try {
    if (!(*given_)(fraction, phase)) is_canceled_ = true;
  } catch (...) {
    thrown_ = std::current_exception();
    is_canceled_ = true;
    throw;
  }
  state.begin_interval();  // starts when the listener returns
  return !is_canceled_;
}

void CancellationScope::ask() {
  if (state.own && !state.own->forward(state.own->fraction_, state.own->phase_)) state.own->rethrow_own();
}

bool CancellationScope::has_listener() { return state.own != nullptr; }

void CancellationScope::rethrow() {
  if (state.own && state.own->is_canceled_) state.own->rethrow_own();
}

void CancellationScope::rethrow_own() const {
  if (thrown_) std::rethrow_exception(thrown_);
  throw Cancelled();
}

bool CancellationScope::is_canceled() { return current() != nullptr && current()->is_canceled_; }

CancellationScope* CancellationScope::current() { return state.own ? state.own : state.other; }

CancellationScope::Joined::Joined(CancellationScope* scope) : before_(std::exchange(state.other, scope)) {}

CancellationScope::Joined::~Joined() { state.other = before_; }

void poll(double nanoseconds) {
  state.worked += nanoseconds;
  if (state.worked < state.next_look) return;
  if (!state.is_due()) {
    state.next_look = state.worked + shared_nanoseconds;
    return;
  }
  state.begin_interval();
  if (state.own) {
    CancellationScope::ask();
  } else if (state.other && state.other->is_canceled_) {
    throw Cancelled();
  }
}

}  // namespace spectral_conformal
