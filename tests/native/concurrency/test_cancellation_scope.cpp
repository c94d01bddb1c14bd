#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

constexpr std::size_t interval = 1000;

/// Nothing depends on the clock while it lives.
class ByStepsAlone {
 public:
  ByStepsAlone() : before_(exchange_poll_interval(interval)) {}
  ~ByStepsAlone() { exchange_poll_interval(before_); }
  ByStepsAlone(const ByStepsAlone&) = delete;
  ByStepsAlone& operator=(const ByStepsAlone&) = delete;

 private:
  std::size_t before_;
};

}  // namespace

TEST_SUITE_BEGIN("cancellation_scope");

TEST_CASE("work is heard once in an interval, with the last report") {
  const ByStepsAlone by_steps;
  std::vector<std::string> heard;
  const Progress progress = [&](double fraction, const char* phase) {
    heard.push_back(phase + std::to_string(static_cast<int>(100 * fraction)));
    return true;
  };
  const CancellationScope scope(progress, "first");
  for (int k = 0; k < 25; ++k) poll(interval / 10);
  report(scope.progress(), 0.5, "second");
  for (int k = 0; k < 15; ++k) poll(interval / 10);
  CHECK(heard == std::vector<std::string>{"first0", "first0", "second50", "second50"});
}

TEST_CASE("steps that take long are heard at once when an interval of the clock has passed") {
  int asked = 0;
  const Progress progress = [&asked](double, const char*) { return ++asked > 0; };
  const CancellationScope scope(progress, "");
  for (int k = 1; k <= 3; ++k) {
    std::this_thread::sleep_for(CancellationScope::interval);
    poll();
    CHECK(asked == k);
  }
}

TEST_CASE("short steps are heard in intervals of the clock, which is looked at between many of them") {
  using Clock = std::chrono::steady_clock;
  std::vector<Clock::time_point> asked{Clock::now()};
  const Progress progress = [&](double, const char*) {
    asked.push_back(Clock::now());
    return asked.size() < 5;
  };
  const CancellationScope scope(progress, "");
  std::size_t n_blocks = 0;
  std::size_t n_steps = 0;
  const auto work = [&] {
    for (;; ++n_blocks) {
      const std::size_t block = steps_before_look();
      n_steps += block;
      poll(block);
    }
  };
  CHECK_THROWS_AS(work(), Cancelled);
  for (std::size_t k = 1; k < asked.size(); ++k) CHECK(asked[k] - asked[k - 1] >= CancellationScope::interval);
  CHECK(n_steps > 1000 * n_blocks);
}

TEST_CASE("each number of many is worked through once, and heard between blocks of them") {
  const ByStepsAlone by_steps;
  int asked = 0;
  const Progress progress = [&asked](double, const char*) { return ++asked > 0; };
  const CancellationScope scope(progress, "");
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{100000}}) {
    asked = 0;
    std::vector<std::size_t> worked;
    for_each_polled(n, [&](std::size_t i) { worked.push_back(i); });
    CHECK(worked.size() == n);
    CHECK(std::is_sorted(worked.begin(), worked.end()));
    CHECK(asked == static_cast<int>(n / interval));
    CHECK(polled_copy(worked) == worked);
  }
}

TEST_CASE("where nobody listens nothing happens") {
  const ByStepsAlone by_steps;
  poll(100 * interval);
  const Progress nobody;
  const CancellationScope scope(nobody, "");
  poll(100 * interval);
  CHECK_FALSE(CancellationScope::has_listener());
  CHECK_FALSE(scope.progress());
}

TEST_CASE("a listener that ends the work is not asked again, and others that work for it hear of it") {
  int asked = 0;
  const ByStepsAlone by_steps;
  const Progress progress = [&asked](double, const char*) { return ++asked < 2; };
  const CancellationScope scope(progress, "");
  poll(2 * interval);
  CHECK_THROWS_AS(poll(2 * interval), Cancelled);
  CHECK_THROWS_AS(poll(2 * interval), Cancelled);
  CHECK_THROWS_AS(CancellationScope::rethrow(), Cancelled);
  CHECK(asked == 2);
  bool ended = false;
  std::thread([&ended, caller = CancellationScope::current()] {
    const CancellationScope::Joined joined(caller);
    try {
      poll(2 * interval);
    } catch (const Cancelled&) {
      ended = true;
    }
  }).join();
  CHECK(ended);
}

TEST_CASE("what a listener throws is thrown, and again") {
  const Progress progress = [](double, const char*) -> bool { throw std::runtime_error("listener"); };
  const CancellationScope scope(progress, "");
  for (int k = 0; k < 2; ++k) CHECK_THROWS_WITH_AS(CancellationScope::ask(), "listener", std::runtime_error);
  CHECK(CancellationScope::is_canceled());
}

TEST_CASE("one within another takes its place, until it ends") {
  int outer_asked = 0;
  int inner_asked = 0;
  const Progress outer = [&](double, const char*) { return ++outer_asked > 0; };
  const Progress inner = [&](double, const char*) { return ++inner_asked > 0; };
  const CancellationScope scope(outer, "");
  {
    const CancellationScope within(inner, "");
    CancellationScope::ask();
  }
  CancellationScope::ask();
  CHECK(outer_asked == 1);
  CHECK(inner_asked == 1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
