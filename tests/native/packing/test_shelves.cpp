#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <random>

#include "packing/shelves.h"

namespace spectral_conformal::test {
namespace {

struct OnShelves {
  std::vector<PackedBox> boxes;
  double height = 0;
};

OnShelves on_shelves(double width, std::vector<PackedBox> boxes) {
  std::sort(boxes.begin(), boxes.end(), [](const PackedBox& a, const PackedBox& b) { return a.height > b.height; });
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  put_on_shelves(width, order, boxes);
  double height = 0;
  for (const PackedBox& box : boxes) height = std::max(height, box.y + box.height);
  return {boxes, height};
}

}  // namespace

TEST_SUITE_BEGIN("shelves");

TEST_CASE("boxes fill a strip without overlap") {
  std::mt19937 generator(1);
  const auto chance = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  std::vector<PackedBox> boxes(600);
  double area = 0;
  for (PackedBox& box : boxes) {
    box.width = 0.2 + chance();
    box.height = 0.2 + chance();
    area += box.width * box.height;
  }
  const OnShelves found = on_shelves(15, boxes);
  constexpr double rounding = 1e-12;
  for (std::size_t i = 0; i < found.boxes.size(); ++i) {
    const PackedBox& a = found.boxes[i];
    REQUIRE((a.x >= -rounding && a.y >= 0 && a.x + a.width <= 15 + rounding));
    for (std::size_t j = 0; j < i; ++j) {
      const PackedBox& b = found.boxes[j];
      REQUIRE((a.x + a.width <= b.x + rounding || b.x + b.width <= a.x + rounding || a.y + a.height <= b.y + rounding ||
               b.y + b.height <= a.y + rounding));
    }
  }
  // Each on those below: shelves of straight tops would fill 0.93.
  CHECK(area > 0.96 * 15 * found.height);
}

TEST_CASE("a box as wide as what is left lies on the shelf, and the next shelf falls the other way") {
  const OnShelves found = on_shelves(3, {{0, 0, 1, 4}, {0, 0, 2, 3}, {0, 0, 2, 2}, {0, 0, 1, 1}});
  CHECK((found.boxes[1].x == 1 && found.boxes[1].y == 0));
  CHECK((found.boxes[2].x == 1 && found.boxes[2].y == 3));
  CHECK((found.boxes[3].x == 0 && found.boxes[3].y == 4));
  CHECK(found.height == 5);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
