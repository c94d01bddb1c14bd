#include <doctest/doctest.h>

#include "graph/numbering.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("numbering");

TEST_CASE("indices in an order of some numbers") {
  CHECK(indices_in({3, 0, 2}, 5) == std::vector<int>{1, -1, 2, 0, -1});
  CHECK(indices_in({}, 2) == std::vector<int>{-1, -1});
}

TEST_CASE("marked numbers are numbered in their order") {
  std::vector<int> marks{7, -1, 0, 0, -1};
  const std::vector<int> marked = number_marked(marks);
  CHECK(marks == std::vector<int>{0, -1, 1, 2, -1});
  CHECK(marked == std::vector<int>{0, 2, 3});
  CHECK(indices_in(marked, marks.size()) == marks);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
