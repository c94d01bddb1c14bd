#include <doctest/doctest.h>

#include <atomic>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "concurrency/cancellation_scope.h"
#include "concurrency/forest_schedule.h"
#include "concurrency/thread_budget.h"

namespace spectral_conformal::test {
namespace {

/// Every node under a later one not far away, a few roots among them.
std::vector<int> random_forest(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> parent;
  for (int node = 0; node < n; ++node) {
    const int above = node + 1 + static_cast<int>(random() % 7);
    parent.push_back(above < n && random() % 50 != 0 ? above : -1);
  }
  return parent;
}

std::vector<double> random_cost(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> cost;
  for (int node = 0; node < n; ++node) cost.push_back(random() % 20 == 0 ? 1000.0 : random() % 10);
  return cost;
}

/// The place of each node in the order of the calls; -1 for none.
struct Places {
  explicit Places(int n) : of(n) {
    for (std::atomic<int>& place : of) place = -1;
  }
  void take(int node) {
    CHECK(of[node] == -1);
    of[node] = next++;
  }
  std::vector<std::atomic<int>> of;
  std::atomic<int> next{0};
};

}  // namespace

TEST_SUITE_BEGIN("forest_schedule");

TEST_CASE("each node once, after its children on the way up and after its parent on the way down") {
  const ThreadBudget::Pretended cores(8);
  for (const int n : {1, 2, 10, 3000}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      const std::vector<int> parent = random_forest(n, seed);
      const ForestSchedule schedule = ForestSchedule::of(parent, random_cost(n, seed));
      for (const unsigned threads : {1U, 2U, 5U}) {
        Places up(n);
        schedule.run_up(threads, [&up](int node) { up.take(node); });
        Places down(n);
        schedule.run_down(threads, [&down](int node) { down.take(node); });
        for (int node = 0; node < n; ++node) {
          REQUIRE(up.of[node] >= 0);
          REQUIRE(down.of[node] >= 0);
          if (parent[node] < 0) continue;
          REQUIRE(up.of[node] < up.of[parent[node]]);
          REQUIRE(down.of[node] > down.of[parent[node]]);
        }
      }
    }
  }
}

TEST_CASE("a parent sees what its children wrote in other threads, and a child its parent") {
  const ThreadBudget::Pretended cores(8);
  constexpr int n = 2000;
  const std::vector<int> parent = random_forest(n, 9);
  const ForestSchedule schedule = ForestSchedule::of(parent, std::vector<double>(n, 1.0));
  std::vector<std::vector<int>> children(n);
  for (int node = 0; node < n; ++node) {
    if (parent[node] >= 0) children[parent[node]].push_back(node);
  }
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<int> size(n, 0);
    schedule.run_up(4, [&](int node) {
      size[node] = 1;
      for (const int child : children[node]) size[node] += size[child];
    });
    std::vector<int> depth(n, -1);
    schedule.run_down(4, [&](int node) { depth[node] = parent[node] < 0 ? 0 : depth[parent[node]] + 1; });
    int sizes = 0;
    int depths = 0;
    for (int node = 0; node < n; ++node) {
      sizes += size[node];  // both count pairs of a node and one above it, the node itself on one side only
      depths += depth[node] + 1;
    }
    CHECK(sizes == depths);
  }
}

TEST_CASE("what a call throws arrives, and its parent is not called") {
  const ThreadBudget::Pretended cores(8);
  constexpr int n = 500;
  const std::vector<int> parent = random_forest(n, 3);
  const ForestSchedule schedule = ForestSchedule::of(parent, std::vector<double>(n, 1.0));
  int thrower = 250;
  while (parent[thrower] < 0) ++thrower;
  for (const unsigned threads : {1U, 3U}) {
    std::atomic<bool> parent_called{false};
    const auto work = [&](int node) {
      if (node == thrower) throw std::runtime_error("node");
      if (node == parent[thrower]) parent_called = true;
    };
    CHECK_THROWS_WITH_AS(schedule.run_up(threads, work), "node", std::runtime_error);
    CHECK_FALSE(parent_called);
  }
}

TEST_CASE("a forest without nodes calls nothing") {
  const ThreadBudget::Pretended cores(8);
  int calls = 0;
  ForestSchedule::of({}, {}).run_up(2, [&calls](int) { ++calls; });
  ForestSchedule().run_down(2, [&calls](int) { ++calls; });
  CHECK(calls == 0);
}

TEST_CASE("a listener is asked while its thread waits, and leaves long tasks to threads that have nothing to do") {
  const ThreadBudget::Pretended cores(2);
  const std::thread::id own = std::this_thread::get_id();
  std::atomic<int> asked{0};
  const Progress progress = [&](double, const char*) { return ++asked < 3; };
  const CancellationScope scope(progress, "");
  // Two leaves under a root: one is done by each thread, the root then by the other one.
  const ForestSchedule schedule = ForestSchedule::of({2, 2, -1}, {2, 2, 2});
  std::atomic<int> begun{0};
  bool is_own = false;
  const auto work = [&](int node) {
    ++begun;
    if (node < 2) {
      while (begun < 2) std::this_thread::yield();
      return;
    }
    is_own = std::this_thread::get_id() == own;
    while (!is_own && asked < 3) std::this_thread::yield();
  };
  CHECK_THROWS_AS(schedule.run_up(2, work, 1), Cancelled);
  CHECK_FALSE(is_own);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
