#include <doctest/doctest.h>

#include <tuple>
#include <vector>

#include "mesh/edge_table.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("edge_table");

TEST_CASE("edges come in order, each once, with the values at it") {
  const EdgeTable<char> table(4, [](const auto& visit) {
    visit(3, 1, 'b');
    visit(2, 0, 'c');
    visit(1, 3, 'a');
    visit(1, 0, 'd');
  });
  std::vector<std::tuple<int, int, std::vector<char>>> found;
  table.for_each_edge([&](const auto& ends, const auto* first, const auto* last) {
    std::vector<char> values;
    for (; first != last; ++first) values.push_back(first->value);
    found.emplace_back(ends[0], ends[1], values);
  });
  CHECK(found == decltype(found){{0, 1, {'d'}}, {0, 2, {'c'}}, {1, 3, {'a', 'b'}}});
  CHECK(table.n_edges() == 3);
}

TEST_CASE("no edges") {
  CHECK(EdgeTable<int>(0, [](const auto&) {}).n_edges() == 0);
  CHECK(EdgeTable<int>(7, [](const auto&) {}).n_edges() == 0);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
