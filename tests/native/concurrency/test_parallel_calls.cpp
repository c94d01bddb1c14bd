#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "concurrency/parallel_calls.h"
#include "concurrency/thread_budget.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("parallel_calls");

TEST_CASE("every call is made once") {
  const ThreadBudget::Pretended cores(4);
  for (const int n : {0, 1, 2, 3, 50}) {
    std::vector<int> calls(static_cast<std::size_t>(n), 0);
    run_in_parallel(
        n, [&](int i, const Progress&) { ++calls[static_cast<std::size_t>(i)]; }, {}, "work");
    CHECK(calls == std::vector<int>(static_cast<std::size_t>(n), 1));
  }
}

TEST_CASE("blocks hold every number once, and as many as they are to but for the last") {
  const ThreadBudget::Pretended cores(4);
  constexpr std::size_t block_size = 4;
  for (const std::size_t n : {0, 1, 3, 4, 5, 8, 30}) {
    std::vector<int> calls(n, 0);
    run_blocks_in_parallel(n, block_size, [&](std::size_t begin, std::size_t end) {
      CHECK(begin % block_size == 0);
      CHECK(end == std::min(n, begin + block_size));
      for (std::size_t i = begin; i < end; ++i) ++calls[i];
    });
    CHECK(calls == std::vector<int>(n, 1));
  }
}

TEST_CASE("what a block throws is thrown") {
  const ThreadBudget::Pretended cores(4);
  for (const int n : {4, 40}) {
    const auto work = [](int begin, int) { throw std::runtime_error(std::to_string(begin)); };
    CHECK_THROWS_WITH_AS(run_blocks_in_parallel(n, 4, work), "0", std::runtime_error);
  }
}

TEST_CASE("the progress function is called in the caller's thread, and stops all") {
  const ThreadBudget::Pretended cores(4);
  const std::thread::id own = std::this_thread::get_id();
  int asked = 0;
  bool elsewhere = false;
  const Progress progress = [&](double, const char*) {
    elsewhere = elsewhere || std::this_thread::get_id() != own;
    return ++asked < 5;
  };
  const auto endless = [](int, const Progress& own_progress) {
    while (true) {
      report(own_progress, 0, "work");
      std::this_thread::yield();
    }
  };
  CHECK_THROWS_AS(run_in_parallel(8, endless, progress, "work"), Cancelled);
  CHECK(asked == 5);
  CHECK_FALSE(elsewhere);
}

TEST_CASE("the caller is heard while its thread waits for others") {
  const ThreadBudget::Pretended cores(4);
  int asked = 0;
  const Progress progress = [&](double, const char*) { return ++asked < 3; };
  const auto work = [](int i, const Progress& own_progress) {
    while (i > 0) {
      report(own_progress, 0, "work");
      std::this_thread::yield();
    }
  };
  CHECK_THROWS_AS(run_in_parallel(2, work, progress, "work"), Cancelled);
}

TEST_CASE("of several failures the first is thrown") {
  const ThreadBudget::Pretended cores(4);
  const auto work = [](int i, const Progress&) {
    if (i > 0) throw std::runtime_error(std::to_string(i));
  };
  for (int repetition = 0; repetition < 20; ++repetition) {
    CHECK_THROWS_WITH_AS(run_in_parallel(6, work, {}, "work"), "1", std::runtime_error);
  }
}

TEST_CASE("the fraction done never falls") {
  const ThreadBudget::Pretended cores(4);
  std::vector<double> fractions;
  const Progress progress = [&](double fraction, const char*) {
    fractions.push_back(fraction);
    return true;
  };
  const auto work = [](int i, const Progress& own_progress) {
    report(own_progress, i % 2 == 0 ? 0.9 - 0.1 * i : 0.1 * i, "work");
  };
  run_in_parallel(8, work, progress, "work");
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST_CASE("a call that reports nothing is heard of, and ends the work once it has ended itself") {
  const ThreadBudget::Pretended cores(2);
  std::atomic<int> asked{0};
  bool elsewhere = false;
  const std::thread::id own = std::this_thread::get_id();
  const Progress progress = [&](double fraction, const char* phase) {
    elsewhere = elsewhere || std::this_thread::get_id() != own || fraction != 0.25 || phase != std::string("phase");
    return ++asked < 4;
  };
  const CancellationScope scope(progress, "phase");
  report(scope.progress(), 0.25, "phase");
  bool ended = false;
  const auto call = [&] {
    while (asked < 4) std::this_thread::yield();
    ended = true;
  };
  CHECK_THROWS_AS(call_while_polling(10 * max_unpolled_steps(), call), Cancelled);
  CHECK(ended);
  CHECK(asked == 4);
  CHECK_FALSE(elsewhere);
}

TEST_CASE("what a call throws that reports nothing is thrown, in whatever thread it is made") {
  const auto call = [] { throw std::runtime_error("call"); };
  for (const unsigned n_cores : {1U, 2U}) {
    const ThreadBudget::Pretended cores(n_cores);
    const Progress progress = [](double, const char*) { return true; };
    const CancellationScope scope(progress, "phase");
    CHECK_THROWS_WITH_AS(call_while_polling(10 * max_unpolled_steps(), call), "call", std::runtime_error);
  }
}

TEST_CASE("what the listener throws arrives, from whatever level of calls, and ends the others") {
  const ThreadBudget::Pretended cores(8);
  int asked = 0;
  const Progress progress = [&](double, const char*) {
    if (++asked == 3) throw std::runtime_error("listener");
    return true;
  };
  const CancellationScope scope(progress, "phase");
  const auto endless = [](int, const Progress&) {
    while (true) poll();
  };
  const auto outer = [&](int, const Progress&) { run_in_parallel(3, endless, {}, ""); };
  CHECK_THROWS_WITH_AS(run_in_parallel(3, outer, {}, ""), "listener", std::runtime_error);
  CHECK(asked == 3);
  CHECK(ThreadBudget::n_helpers() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
