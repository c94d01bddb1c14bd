#include <doctest/doctest.h>

#include "parameterization/stopwatch.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("stopwatch");

TEST_CASE("phases keep their order, and laps of one phase add up") {
  Timings timings;
  Stopwatch watch(timings);
  watch.lap("first");
  watch.lap("second");
  const double before = timings[0].second;
  for (volatile int k = 0; k < 100000; k = k + 1) {
  }
  watch.lap("first");
  REQUIRE(timings.size() == 2);
  CHECK((timings[0].first == "first" && timings[1].first == "second"));
  CHECK(timings[0].second > before);
  CHECK(timings[1].second >= 0);
}

TEST_CASE("seconds of several are added phase by phase") {
  Timings sum{{"first", 1.0}, {"second", 2.0}};
  add_seconds({{"second", 4.0}, {"third", 8.0}}, sum);
  CHECK(sum == Timings{{"first", 1.0}, {"second", 6.0}, {"third", 8.0}});
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
