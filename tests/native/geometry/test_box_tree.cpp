#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "geometry/box_tree.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

/// Boxes of random places and sizes, some without extent.
std::vector<PlaneBox> random_boxes(int n, double size, unsigned seed) {
  const ComplexVector random = random_map(2 * n, seed);
  std::vector<PlaneBox> boxes;
  for (int i = 0; i < n; ++i) {
    const Complex low = random[2 * i];
    const double width = i % 5 == 0 ? 0 : size * std::abs(random[2 * i + 1].real());
    const double height = i % 7 == 0 ? 0 : size * std::abs(random[2 * i + 1].imag());
    boxes.push_back({{low.real(), low.imag()}, {low.real() + width, low.imag() + height}});
  }
  return boxes;
}

std::vector<int> meeting(const BoxTree& tree, const PlaneBox& box) {
  std::vector<int> found;
  tree.for_each_meeting(box, [&](int index) {
    found.push_back(index);
    return true;
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

TEST_SUITE_BEGIN("box_tree");

TEST_CASE("finds the boxes that a look at all of them finds") {
  for (const int n : {1, 4, 5, 6, 17, 300}) {
    for (const double size : {0.02, 0.3, 3.0}) {
      const std::vector<PlaneBox> boxes = random_boxes(n, size, static_cast<unsigned>(n));
      const BoxTree tree = BoxTree::over(boxes);
      for (const PlaneBox& box : random_boxes(40, size, 99)) {
        std::vector<int> expected;
        for (int i = 0; i < n; ++i) {
          if (boxes[i].meets(box)) expected.push_back(i);
        }
        CHECK(meeting(tree, box) == expected);
      }
    }
  }
}

TEST_CASE("touching is meeting") {
  const PlaneBox unit{{0, 0}, {1, 1}};
  CHECK(unit.meets({{1, 1}, {2, 2}}));
  CHECK(unit.meets({{0.5, 0.5}, {0.5, 0.5}}));
  CHECK_FALSE(unit.meets({{1.001, 0}, {2, 1}}));
  CHECK_FALSE(unit.meets({{0, -2}, {1, -0.001}}));
}

TEST_CASE("stops when told to, and many equal boxes are no trouble") {
  const std::vector<PlaneBox> boxes(100000, PlaneBox{{0, 0}, {1, 1}});
  const BoxTree tree = BoxTree::over(boxes);
  int calls = 0;
  tree.for_each_meeting({{0.5, 0.5}, {2, 2}}, [&](int) { return ++calls < 3; });
  CHECK(calls == 3);
  std::vector<int> all(boxes.size());
  std::iota(all.begin(), all.end(), 0);
  CHECK(meeting(tree, {{1, 1}, {1, 1}}) == all);
}

TEST_CASE("no boxes") { CHECK(meeting(BoxTree::over({}), {{0, 0}, {1, 1}}).empty()); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test
