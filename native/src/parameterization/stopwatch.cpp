#include "parameterization/stopwatch.h"

#include <algorithm>

namespace spectral_conformal {

void Stopwatch::lap(const char* phase) {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  const auto known = std::find_if(timings_.begin(), timings_.end(), [&](const auto& t) { return t.first == phase; });
  if (known != timings_.end()) {
    known->second += seconds;
  } else {
    timings_.emplace_back(phase, seconds);
  }
}

}  // namespace spectral_conformal
