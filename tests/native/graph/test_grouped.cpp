#include <doctest/doctest.h>

#include <vector>

#include "graph/grouped.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("grouped");

TEST_CASE("values of a key keep their order, and keys may have none") {
  const Grouped<char> grouped(4, [](const auto& visit) {
    visit(2, 'a');
    visit(0, 'b');
    visit(2, 'c');
  });
  CHECK(grouped.n_keys() == 4);
  CHECK(grouped.values() == std::vector<char>{'b', 'a', 'c'});
  const std::vector<int> sizes{1, 0, 2, 0};
  for (int key = 0; key < 4; ++key) {
    CHECK(grouped[key].size() == sizes[static_cast<std::size_t>(key)]);
    CHECK(grouped[key].empty() == (grouped[key].size() == 0));
    CHECK(grouped[key].begin() == grouped.values().data() + grouped.first(key));
    CHECK(grouped[key].end() == grouped.values().data() + grouped.first(key + 1));
  }
}

TEST_CASE("values may be changed within a key") {
  Grouped<int> grouped(2, [](const auto& visit) {
    visit(1, 3);
    visit(0, 5);
    visit(1, 4);
  });
  for (int& value : grouped[1]) value += 10;
  CHECK(grouped.values() == std::vector<int>{5, 13, 14});
}

TEST_CASE("no keys") {
  CHECK(Grouped<int>().n_keys() == 0);
  CHECK(Grouped<int>(0, [](const auto&) {}).values().empty());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
