#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "spectral_conformal/box_packing.h"

namespace spectral_conformal::test {
namespace {

std::vector<PackedBox> random_boxes(int n, double power) {
  std::mt19937 generator(static_cast<unsigned>(n));
  std::vector<PackedBox> boxes(static_cast<std::size_t>(n));
  const auto next = [&] { return std::pow(0.2 + 0.8 * static_cast<double>(generator()) / 4294967295.0, power); };
  for (PackedBox& box : boxes) {
    box.width = next();
    box.height = next();
  }
  return boxes;
}

bool overlap(const PackedBox& a, const PackedBox& b) {
  constexpr double rounding = 1e-12;
  return a.x + a.width > b.x + rounding && b.x + b.width > a.x + rounding && a.y + a.height > b.y + rounding &&
         b.y + b.height > a.y + rounding;
}

}  // namespace

TEST_SUITE_BEGIN("box_packing");

TEST_CASE("no box overlaps another, none leaves the square, and most of it is filled") {
  for (const int n : {1, 2, 7, 100, 700}) {
    for (const double power : {1.0, 5.0}) {
      std::vector<PackedBox> boxes = random_boxes(n, power);
      const std::vector<PackedBox> given = boxes;
      const double side = pack_boxes(boxes);
      double area = 0;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const PackedBox& box = boxes[i];
        CHECK((box.width == given[i].width && box.height == given[i].height));
        CHECK((box.x >= 0 && box.y >= 0 && box.x + box.width <= side && box.y + box.height <= side));
        for (std::size_t j = 0; j < i; ++j) REQUIRE_FALSE(overlap(box, boxes[j]));
        area += box.width * box.height;
      }
      if (n >= 100) CHECK(area > (n == 100 ? 0.85 : 0.97) * side * side);
    }
  }
}

TEST_CASE("equal squares make a square") {
  std::vector<PackedBox> boxes(100, {0, 0, 1, 1});
  CHECK(pack_boxes(boxes) == doctest::Approx(10));
  boxes.assign(6, {0, 0, 2, 2});
  CHECK(pack_boxes(boxes) == doctest::Approx(6));
}

TEST_CASE("nothing, a point, lines and one long box") {
  std::vector<PackedBox> boxes;
  CHECK(pack_boxes(boxes) == 0);
  boxes = {{3, 3, 0, 0}};
  CHECK(pack_boxes(boxes) == 0);
  CHECK((boxes[0].x == 0 && boxes[0].y == 0));
  boxes = {{0, 0, 5, 0}, {0, 0, 0, 2}};
  CHECK(pack_boxes(boxes) == doctest::Approx(5));
  boxes = {{0, 0, 1, 50}, {0, 0, 30, 1}};
  CHECK(pack_boxes(boxes) == doctest::Approx(50));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
