#include "concurrency/cancellation_scope.h"

#include <utility>

namespace spectral_conformal {
namespace {

using Clock = std::chrono::steady_clock;

/// A look at the clock takes 25 ns, on few machines a microsecond: less than all of these steps. If these become slow
/// after a look, 10 microseconds each, they still pass in an interval.
constexpr std::size_t max_steps_between_looks = 4096;
constexpr std::chrono::duration<double, std::milli> between_looks{1};

std::atomic<std::size_t> interval_of_test{0};  ///< in steps; 0 for none

struct PollState {
  CancellationScope* own = nullptr;
  CancellationScope* other = nullptr;  ///< of the thread that this one works for
  std::size_t planned = 1;             ///< steps from one look at the clock to the next
  std::size_t done = 0;                ///< of these
  Clock::time_point looked;
  Clock::time_point asked;  ///< when the listener returned

  void begin_interval() {
    done = 0;
    planned = interval_of_test;
    if (planned > 0) return;
    planned = 1;
    looked = asked = Clock::now();
  }
  /// Plans the next look. Returns whether it is time to ask.
  bool look() {
    if (interval_of_test > 0) return true;
    const Clock::time_point now = Clock::now();
    const double fitting = static_cast<double>(done) * (between_looks / (now - std::exchange(looked, now)));
    // Fewer than fit, if the next steps take longer.
    planned = fitting > max_steps_between_looks ? max_steps_between_looks
                                                : std::max(std::size_t{1}, static_cast<std::size_t>(fitting));
    done = 0;
    return now - asked >= CancellationScope::interval;
  }
};

thread_local PollState state;

}  // namespace

std::size_t exchange_poll_interval(std::size_t steps) { return interval_of_test.exchange(steps); }

std::size_t max_unpolled_steps() {
  const std::size_t interval = interval_of_test;
  return interval > 0 ? interval : 100'000;
}

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

void poll(std::size_t steps) {
  state.done += steps;
  if (state.done < state.planned || !state.look()) return;
  state.begin_interval();
  if (state.own) {
    CancellationScope::ask();
  } else if (state.other && state.other->is_canceled_) {
    throw Cancelled();
  }
}

std::size_t steps_before_look() { return state.planned > state.done ? state.planned - state.done : 1; }

}  // namespace spectral_conformal
