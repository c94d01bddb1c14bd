#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "concurrency/listening.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

constexpr double interval = Listening::interval.count();

/// Nothing depends on the clock while it lives.
class ByWorkAlone {
 public:
  ByWorkAlone() : before_(exchange_listening_interval(interval)) {}
  ~ByWorkAlone() { exchange_listening_interval(before_); }
  ByWorkAlone(const ByWorkAlone&) = delete;
  ByWorkAlone& operator=(const ByWorkAlone&) = delete;

 private:
  double before_;
};

}  // namespace

TEST_SUITE_BEGIN("listening");

TEST_CASE("work is heard once in an interval, with the last report") {
  const ByWorkAlone by_work;
  std::vector<std::string> heard;
  const Progress progress = [&](double fraction, const char* phase) {
    heard.push_back(phase + std::to_string(static_cast<int>(100 * fraction)));
    return true;
  };
  const Listening listening(progress, "first");
  for (int k = 0; k < 25; ++k) still_working(0.1 * interval);
  report(listening.progress(), 0.5, "second");
  for (int k = 0; k < 15; ++k) still_working(0.1 * interval);
  CHECK(heard == std::vector<std::string>{"first0", "first0", "second50", "second50"});
}

TEST_CASE("work that takes much longer than it says is heard in an interval of the clock") {
  int asked = 0;
  const Progress progress = [&asked](double, const char*) { return ++asked > 0; };
  const Listening listening(progress, "");
  for (int k = 1; k <= 3; ++k) {
    std::this_thread::sleep_for(Listening::interval);
    still_working(0.1 * interval);
    CHECK(asked == k);
  }
}

TEST_CASE("each number of many is worked through once, and heard between blocks of them") {
  const ByWorkAlone by_work;
  int asked = 0;
  const Progress progress = [&asked](double, const char*) { return ++asked > 0; };
  const Listening listening(progress, "");
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{100000}}) {
    asked = 0;
    std::vector<std::size_t> worked;
    for_each_heard(n, 10 * interval / static_cast<double>(n + 1), [&](std::size_t i) { worked.push_back(i); });
    CHECK(worked.size() == n);
    CHECK(std::is_sorted(worked.begin(), worked.end()));
    CHECK(asked == (n == 0 ? 0 : n == 1 ? 1 : 9));
    CHECK(heard_copy(worked) == worked);
  }
}

TEST_CASE("where nobody listens nothing happens") {
  still_working(100 * interval);
  const Progress nobody;
  const Listening listening(nobody, "");
  still_working(100 * interval);
  CHECK_FALSE(Listening::has_listener());
  CHECK_FALSE(listening.progress());
}

TEST_CASE("a listener that ends the work is not asked again, and others that work for it hear of it") {
  int asked = 0;
  const Progress progress = [&asked](double, const char*) { return ++asked < 2; };
  const Listening listening(progress, "");
  still_working(2 * interval);
  CHECK_THROWS_AS(still_working(2 * interval), Cancelled);
  CHECK_THROWS_AS(still_working(2 * interval), Cancelled);
  CHECK_THROWS_AS(Listening::rethrow(), Cancelled);
  CHECK(asked == 2);
  bool ended = false;
  std::thread([&ended, caller = Listening::current()] {
    const Listening::Overheard overheard(caller);
    try {
      still_working(2 * interval);
    } catch (const Cancelled&) {
      ended = true;
    }
  }).join();
  CHECK(ended);
}

TEST_CASE("what a listener throws is thrown, and again") {
  const Progress progress = [](double, const char*) -> bool { throw std::runtime_error("listener"); };
  const Listening listening(progress, "");
  for (int k = 0; k < 2; ++k) CHECK_THROWS_WITH_AS(Listening::ask(), "listener", std::runtime_error);
  CHECK(Listening::is_canceled());
}

TEST_CASE("one within another takes its place, until it ends") {
  int outer_asked = 0;
  int inner_asked = 0;
  const Progress outer = [&](double, const char*) { return ++outer_asked > 0; };
  const Progress inner = [&](double, const char*) { return ++inner_asked > 0; };
  const Listening listening(outer, "");
  {
    const Listening within(inner, "");
    Listening::ask();
  }
  Listening::ask();
  CHECK(outer_asked == 1);
  CHECK(inner_asked == 1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
