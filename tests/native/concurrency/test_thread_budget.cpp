#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "concurrency/forest_schedule.h"
#include "concurrency/helper_threads.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/thread_budget.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::test {
namespace {

/// Three levels of calls, the innermost a forest, each in as many threads as it gets.
void nested_calls(const std::function<void()>& innermost) {
  const ForestSchedule forest = ForestSchedule::of(std::vector<int>(12, -1), std::vector<double>(12, 1.0));
  run_in_parallel(
      5,
      [&](int, const Progress&) {
        run_in_parallel(
            7, [&](int, const Progress&) { forest.run_up(64, [&](int) { innermost(); }); }, {}, "");
      },
      {}, "");
}

/// The most helpers in the process while the calls are made.
unsigned most_helpers(const std::function<void(const std::function<void()>&)>& calls) {
  std::atomic<unsigned> most{0};
  calls([&most] {
    const unsigned n = ThreadBudget::n_helpers();
    unsigned before = most;
    while (before < n && !most.compare_exchange_weak(before, n)) {
    }
    std::this_thread::yield();
  });
  return most;
}

}  // namespace

TEST_SUITE_BEGIN("thread_budget");

TEST_CASE("calls within calls have no more threads than there are cores, and use them") {
  for (const unsigned n : {1U, 2U, 5U, 16U}) {
    const ThreadBudget::Pretended cores(n);
    unsigned most = 0;
    for (int repeat = 0; repeat < 10; ++repeat) {
      const unsigned helpers = most_helpers(nested_calls);
      CHECK(helpers < n);
      most = std::max(most, helpers);
    }
    // Parts are whole: of 16 cores, three for each of 5 calls.
    CHECK(4 * (most + 1) >= 3 * n);
    CHECK(ThreadBudget::n_helpers() == 0);
  }
}

TEST_CASE("the same of a limit") {
  const ThreadBudget::Pretended cores(16);
  const ThreadLimit limit(6);
  for (int repeat = 0; repeat < 10; ++repeat) CHECK(most_helpers(nested_calls) < 6);
}

TEST_CASE("several callers at once share the cores, each of them one of the threads") {
  constexpr unsigned n_callers = 3;
  for (const unsigned n : {1U, 3U, 8U}) {
    const ThreadBudget::Pretended cores(n);
    const auto calls = [](const std::function<void()>& innermost) {
      std::atomic<unsigned> ready{0};
      std::vector<std::thread> callers;
      for (unsigned k = 0; k < n_callers; ++k) {
        callers.emplace_back([&] {
          ++ready;
          while (ready < n_callers) std::this_thread::yield();
          for (int repeat = 0; repeat < 5; ++repeat) nested_calls(innermost);
        });
      }
      for (std::thread& caller : callers) caller.join();
    };
    CHECK(most_helpers(calls) < std::max(n, 2U));
    CHECK(ThreadBudget::n_helpers() == 0);
  }
}

TEST_CASE("threads that have ended leave their part to those that work on") {
  const ThreadBudget::Pretended cores(4);
  std::atomic<bool> is_to_end{false};
  const HelperThreads helper(1, [&] {
    while (!is_to_end) std::this_thread::yield();
  });
  REQUIRE(helper.size() == 1);
  CHECK(ThreadBudget::available() == 2);
  is_to_end = true;
  while (ThreadBudget::available() < 4) std::this_thread::yield();
  CHECK(HelperThreads(5, [] {}).size() == 3);
}

TEST_CASE("a thread that waits for its helpers leaves its part to them") {
  const ThreadBudget::Pretended cores(4);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> n_begun{0};
  std::size_t helpers = 0;
  const auto work = [&](int, const Progress&) {
    ++n_begun;
    while (n_begun < 2) std::this_thread::yield();
    if (std::this_thread::get_id() == caller) return;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (helpers < 3 && std::chrono::steady_clock::now() < end) helpers = HelperThreads(5, [] {}).size();
  };
  run_in_parallel(2, work, {}, "");
  CHECK(helpers == 3);
  CHECK(ThreadBudget::n_helpers() == 0);
  CHECK(ThreadBudget::available() == 4);
}

TEST_CASE("what is thrown gives all threads back") {
  const ThreadBudget::Pretended cores(8);
  CHECK_THROWS_AS(nested_calls([] { throw std::runtime_error("call"); }), std::runtime_error);
  CHECK(ThreadBudget::n_helpers() == 0);
  CHECK(ThreadBudget::available() == 8);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
