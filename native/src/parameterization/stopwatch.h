#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace spectral_conformal {

/// Seconds per phase, in the order of their first appearance.
using Timings = std::vector<std::pair<std::string, double>>;

/// Adds the seconds until the next call to the named phase.
class Stopwatch {
 public:
  explicit Stopwatch(Timings& timings) : timings_(timings), last_(Clock::now()) {}
  void lap(const char* phase);

 private:
  using Clock = std::chrono::steady_clock;
  Timings& timings_;
  Clock::time_point last_;
};

/// sum += part, phase by phase.
void add_seconds(const Timings& part, Timings& sum);

}  // namespace spectral_conformal
