#include <doctest/doctest.h>

#include "packing/packing.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("packing");

TEST_CASE("islands with room are counted") {
  CHECK(n_with_room({}) == 0);
  CHECK(n_with_room({2, std::vector<PlaneMotion>(3), {true, false, true}}) == 2);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
