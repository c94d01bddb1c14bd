#include "parameterization/stopwatch.h"

#include <algorithm>

namespace spectral_conformal {

namespace {

void add_phase(const std::string& phase, double seconds, Timings& timings) {
  const auto known = std::find_if(timings.begin(), timings.end(), [&](const auto& t) { return t.first == phase; });
  if (known != timings.end()) {
    known->second += seconds;
  } else {
    timings.emplace_back(phase, seconds);
  }
}

}  // namespace

void Stopwatch::lap(const char* phase) {
  const auto now = Clock::now();
  add_phase(phase, std::chrono::duration<double>(now - last_).count(), timings_);
  last_ = now;
}

void add_seconds(const Timings& part, Timings& sum) {
  for (const auto& [phase, seconds] : part) add_phase(phase, seconds, sum);
}

}  // namespace spectral_conformal
