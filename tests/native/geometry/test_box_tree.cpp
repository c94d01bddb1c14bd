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

TEST_CASE("of moving boxes, all that meet at some time are found, and none that move alike") {
  constexpr int n = 200;
  const std::vector<PlaneBox> places = random_boxes(n, 0.1, 5);
  const ComplexVector motions = random_map(n, 6);
  std::vector<MovingBox> boxes;
  for (int i = 0; i < n; ++i) boxes.push_back({places[i], PlaneBox::of({motions[i]})});
  const MovingBoxTree tree = MovingBoxTree::over(boxes);
  const auto at = [](const MovingBox& box, double time) {
    const Complex way = time * box.motions.low_corner();
    return PlaneBox::of({box.places.low_corner() + way, box.places.high_corner() + way});
  };
  int n_passing = 0;
  for (const MovingBox& box : boxes) {
    std::vector<char> is_found(n, 0);
    tree.for_each_meeting(box, [&](int k) {
      is_found[k] = 1;
      return true;
    });
    for (int k = 0; k < n; ++k) {
      bool meets = false;
      for (int step = 0; step <= 100; ++step) meets = meets || at(box, 0.01 * step).meets(at(boxes[k], 0.01 * step));
      if (meets) CHECK(is_found[k]);
      // That meet only between these times are few.
      if (is_found[k] && !meets) ++n_passing;
    }
  }
  CHECK(n_passing < n * n / 100);
  const MovingBox still{PlaneBox::of({0, {1, 1}}), PlaneBox::of({0})};
  MovingBox beside = still;
  beside.places = PlaneBox::of({{1.1, 0}, {2, 1}});
  CHECK_FALSE(still.meets(beside));
  beside.motions = PlaneBox::of({-0.1});
  CHECK(still.meets(beside));
  MovingBox fast = still;
  fast.motions = beside.motions = PlaneBox::of({{100, -50}});
  CHECK_FALSE(fast.meets(beside));
}

TEST_CASE("no boxes") { CHECK(meeting(BoxTree::over({}), {{0, 0}, {1, 1}}).empty()); }

TEST_SUITE_END();

}  // namespace spectral_conformal::test
