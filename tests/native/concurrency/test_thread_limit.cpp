#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "concurrency/helper_threads.h"
#include "concurrency/parallel_calls.h"
#include "concurrency/thread_budget.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("thread_limit");

TEST_CASE("limits nest, and are of one thread") {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  CHECK(ThreadLimit::current() == 0);
  CHECK(ThreadLimit::available() == cores);
  {
    const ThreadLimit outer(3);
    CHECK(ThreadLimit::available() == std::min(3U, cores));
    {
      const ThreadLimit inner(1);
      CHECK(ThreadLimit::available() == 1);
    }
    CHECK(ThreadLimit::current() == 3);
    unsigned elsewhere = 1;
    std::thread([&] { elsewhere = ThreadLimit::current(); }).join();
    CHECK(elsewhere == 0);
  }
  CHECK(ThreadLimit::current() == 0);
  CHECK(ThreadLimit::exchange(2) == 0);
  CHECK(ThreadLimit::exchange(0) == 2);
}

TEST_CASE("helpers have the limit of the thread they work for") {
  const ThreadBudget::Pretended cores(8);
  const ThreadLimit limit(5);
  std::atomic<int> others{0};
  {
    const HelperThreads helpers(3, [&] { others += ThreadLimit::current() == 5 ? 0 : 1; });
  }
  CHECK(others == 0);
}

TEST_CASE("calls within calls stay under the limit together") {
  const ThreadBudget::Pretended cores(16);
  for (const unsigned most : {1U, 2U, 6U}) {
    const ThreadLimit limit(most);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    unsigned largest = 0;
    unsigned running = 0;
    const auto inner = [&](int, const Progress&) {
      {
        const std::lock_guard<std::mutex> lock(mutex);
        largest = std::max(largest, ++running);
        threads.insert(std::this_thread::get_id());
      }
      std::this_thread::yield();
      const std::lock_guard<std::mutex> lock(mutex);
      --running;
    };
    const auto outer = [&](int, const Progress& progress) { run_in_parallel(20, inner, progress, "work"); };
    run_in_parallel(20, outer, {}, "work");
    CHECK(largest <= most);
    CHECK((most > 1 || threads == std::set<std::thread::id>{std::this_thread::get_id()}));
    CHECK(ThreadLimit::current() == most);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
