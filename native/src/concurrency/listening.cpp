#include "concurrency/listening.h"

#include <utility>

namespace spectral_conformal {
namespace {

using Clock = std::chrono::steady_clock;

std::atomic<double> interval_of_test{0};  ///< of work, in nanoseconds; 0 for none

struct Ear {
  Listening* own = nullptr;
  Listening* other = nullptr;  ///< of the thread that this one works for
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
    return interval_of_test > 0 || worked >= Listening::interval.count() || Clock::now() - asked >= Listening::interval;
  }
};

thread_local Ear ear;

}  // namespace

double exchange_listening_interval(double nanoseconds) { return interval_of_test.exchange(nanoseconds); }

double listening_interval() {
  const double interval = interval_of_test;
  return interval > 0 ? interval : Listening::interval.count();
}

double take_longest_silence() { return std::exchange(ear.longest_silence, 0.0); }

Listening::Listening(const Progress& progress, const char* phase) : given_(&progress), phase_(phase) {
  if (!progress) return;
  heard_ = [this](double fraction, const char* phase) { return hear(fraction, phase); };
  before_ = std::exchange(ear.own, this);
  ear.begin_interval();
}

Listening::~Listening() {
  if (heard_) ear.own = before_;
}

bool Listening::hear(double fraction, const char* phase) {
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
  ear.begin_interval();  // starts when the listener returns
  return !is_canceled_;
}

void Listening::ask() {
  if (ear.own && !ear.own->hear(ear.own->fraction_, ear.own->phase_)) ear.own->rethrow_own();
}

bool Listening::has_listener() { return ear.own != nullptr; }

void Listening::rethrow() {
  if (ear.own && ear.own->is_canceled_) ear.own->rethrow_own();
}

void Listening::rethrow_own() const {
  if (thrown_) std::rethrow_exception(thrown_);
  throw Cancelled();
}

bool Listening::is_canceled() { return current() != nullptr && current()->is_canceled_; }

Listening* Listening::current() { return ear.own ? ear.own : ear.other; }

Listening::Overheard::Overheard(Listening* listening) : before_(std::exchange(ear.other, listening)) {}

Listening::Overheard::~Overheard() { ear.other = before_; }

void still_working(double nanoseconds) {
  ear.worked += nanoseconds;
  if (ear.worked < ear.next_look) return;
  if (!ear.is_due()) {
    ear.next_look = ear.worked + shared_nanoseconds;
    return;
  }
  ear.begin_interval();
  if (ear.own) {
    Listening::ask();
  } else if (ear.other && ear.other->is_canceled_) {
    throw Cancelled();
  }
}

}  // namespace spectral_conformal
