#include "graph/listening.h"

#include <utility>

namespace spectral_conformal {
namespace {

std::atomic<double> interval_of_work{static_cast<double>(std::chrono::nanoseconds(Listening::interval).count())};

struct Ear {
  Listening* own = nullptr;
  Listening* other = nullptr;  ///< of the thread that this one works for
  double left = 0;
};

thread_local Ear ear;

}  // namespace

double exchange_listening_interval(double nanoseconds) { return interval_of_work.exchange(nanoseconds); }

Listening::Listening(const Progress& progress, const char* phase) : given_(&progress), phase_(phase) {
  if (!progress) return;
  heard_ = [this](double fraction, const char* phase) { return hear(fraction, phase); };
  before_ = std::exchange(ear.own, this);
  ear.left = interval_of_work;
}

Listening::~Listening() {
  if (heard_) ear.own = before_;
}

bool Listening::hear(double fraction, const char* phase) {
  ear.left = interval_of_work;
  fraction_ = fraction;
  phase_ = phase;
  if (is_cancelled_) return false;
  try {
    if (!(*given_)(fraction, phase)) is_cancelled_ = true;
  } catch (...) {
    thrown_ = std::current_exception();
    is_cancelled_ = true;
    throw;
  }
  return !is_cancelled_;
}

void Listening::ask() {
  if (ear.own && !ear.own->hear(ear.own->fraction_, ear.own->phase_)) ear.own->rethrow_own();
}

bool Listening::has_listener() { return ear.own != nullptr; }

void Listening::rethrow() {
  if (ear.own && ear.own->is_cancelled_) ear.own->rethrow_own();
}

void Listening::rethrow_own() const {
  if (thrown_) std::rethrow_exception(thrown_);
  throw Cancelled();
}

bool Listening::is_cancelled() { return current() != nullptr && current()->is_cancelled_; }

Listening* Listening::current() { return ear.own ? ear.own : ear.other; }

Listening::Overheard::Overheard(Listening* listening) : before_(std::exchange(ear.other, listening)) {}

Listening::Overheard::~Overheard() { ear.other = before_; }

void still_working(double nanoseconds) {
  ear.left -= nanoseconds;
  if (ear.left > 0) return;
  ear.left = interval_of_work;
  if (ear.own) {
    Listening::ask();
  } else if (ear.other && ear.other->is_cancelled_) {
    throw Cancelled();
  }
}

}  // namespace spectral_conformal
