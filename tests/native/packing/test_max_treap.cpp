#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <vector>

#include "packing/max_treap.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("max_treap");

TEST_CASE("items are found as in a list, whatever is put in and taken out") {
  std::mt19937 generator(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(generator() % n); };
  MaxTreap treap;
  std::vector<int> list;
  std::vector<int> unused(60);
  for (int k = 0; k < 60; ++k) unused[static_cast<std::size_t>(k)] = 59 - k;
  for (int k = 0; k < 3000; ++k) {
    if (!unused.empty() && (list.empty() || generator() % 2 == 0)) {
      const std::size_t at = below(list.size() + 1);
      const int before = at < list.size() ? list[at] : MaxTreap::none;
      treap.insert_before(before, unused.back(), static_cast<double>(generator() % 20));
      list.insert(list.begin() + static_cast<std::ptrdiff_t>(at), unused.back());
      unused.pop_back();
    } else if (generator() % 2 == 0) {
      treap.set_value(list[below(list.size())], static_cast<double>(generator() % 20));
    } else {
      const std::size_t at = below(list.size());
      treap.erase(list[at]);
      unused.push_back(list[at]);
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(at));
    }
    if (list.empty()) {
      CHECK(treap.first_above(-1) == MaxTreap::none);
      continue;
    }
    const auto limit = static_cast<double>(generator() % 20);
    const auto is_above = [&](int item) { return treap.value(item) > limit; };
    const auto item = [&](auto found, auto end) { return found == end ? MaxTreap::none : *found; };
    const auto at = list.begin() + static_cast<std::ptrdiff_t>(below(list.size()));
    CHECK(treap.first_above(limit) == item(std::find_if(list.begin(), list.end(), is_above), list.end()));
    CHECK(treap.next_above(*at, limit) == item(std::find_if(at + 1, list.end(), is_above), list.end()));
    const auto back = std::find_if(std::make_reverse_iterator(at), list.rend(), is_above);
    CHECK(treap.previous_above(*at, limit) == item(back, list.rend()));
    const auto is_behind = [&](int other) { return std::find(list.begin(), at, other) == at; };
    CHECK(treap.first_behind(is_behind) == *at);
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
