#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "graph/disjoint_sets.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("disjoint_sets");

TEST_CASE("the smallest element names a set, whatever the order of the unions") {
  for (const bool forward : {true, false}) {
    DisjointSets sets(8);
    const std::vector<std::array<int, 2>> pairs{{7, 5}, {5, 3}, {6, 4}, {3, 1}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [a, b] = pairs[forward ? i : pairs.size() - 1 - i];
      CHECK(sets.unite(a, b));
    }
    std::vector<int> roots;
    for (int i = 0; i < 8; ++i) roots.push_back(sets.find(i));
    CHECK(roots == std::vector<int>{0, 1, 2, 1, 4, 1, 4, 1});
    CHECK_FALSE(sets.unite(7, 1));
    CHECK_FALSE(sets.unite(2, 2));
  }
}

TEST_CASE("the caller may say what names a set") {
  DisjointSets sets(5);
  sets.attach(0, 4);
  sets.attach(4, 2);
  for (const int i : {0, 2, 4}) CHECK(sets.find(i) == 2);
  CHECK(sets.find(1) == 1);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
