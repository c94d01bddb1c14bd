#include <doctest/doctest.h>

#include <atomic>

#include "concurrency/helper_threads.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("helper_threads");

TEST_CASE("every thread does the work, and all have done it when the object ends") {
  const ThreadBudget::Pretended cores(8);
  for (const unsigned count : {0U, 1U, 5U}) {
    std::atomic<unsigned> done{0};
    std::size_t size = 0;
    {
      const HelperThreads helpers(count, [&done] { ++done; });
      size = helpers.size();
    }
    CHECK(done == size);
    CHECK(size <= count);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
