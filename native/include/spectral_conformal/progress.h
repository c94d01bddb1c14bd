#pragma once

#include <functional>

#include "spectral_conformal/errors.h"

namespace spectral_conformal {

/// Receives the fraction done, 0 to 1, and the name of the phase; returns false to cancel.
using Progress = std::function<bool(double fraction, const char* phase)>;

/// Reports progress if there is a listener. Throws Cancelled if the listener asks to stop.
inline void report(const Progress& progress, double fraction, const char* phase) {
  if (progress && !progress(fraction, phase)) throw Cancelled();
}

/// Maps the progress of a subtask to the part [from, to] of the whole.
inline Progress part(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double fraction, const char* phase) {
    return progress(from + (to - from) * fraction, phase);
  };
}

}  // namespace spectral_conformal
