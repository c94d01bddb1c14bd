#include <doctest/doctest.h>

#include <vector>

#include "seams/triangle_forest.h"

namespace spectral_conformal::test {
namespace {

PlaneTriangle triangle(Complex a, Complex b, Complex c) { return PlaneTriangle({a, b, c}); }

/// A square of side 1 with its lower left corner at a point.
std::vector<PlaneTriangle> square(Complex at) {
  const Complex i(0, 1);
  return {triangle(at, at + 1.0, at + 1.0 + i), triangle(at, at + 1.0 + i, at + i)};
}

}  // namespace

TEST_SUITE_BEGIN("triangle_forest");

TEST_CASE("what is added, in whatever parts, is found, and contact within the tolerance is no overlap") {
  TriangleForest forest;
  for (int k = 0; k < 9; ++k) forest.add(square(k));
  CHECK(forest.overlaps(triangle({8.2, 0.5}, {8.8, 0.5}, {8.5, 3}), 0.02));
  CHECK_FALSE(forest.overlaps(triangle({8.2, 1}, {8.8, 1}, {8.5, 3}), 0.02));
  CHECK_FALSE(forest.overlaps(triangle({8.2, 0.999}, {8.8, 0.999}, {8.5, 3}), 0.02));
  TriangleForest elsewhere;
  elsewhere.add(forest.moved({Complex(0, 1), false, Complex(0, -5)}));
  CHECK(elsewhere.overlaps(triangle({-0.5, 3.2}, {-0.5, 3.8}, {-3, 3.5}), 0.02));
  CHECK_FALSE(elsewhere.overlaps(triangle({0.2, 3}, {0.8, 3}, {0.5, 4}), 0.02));
}

TEST_CASE("widths along a segment are those within a depth from it") {
  TriangleForest forest;
  for (int k = 0; k < 3; ++k) forest.add(square(k));
  forest.add({triangle({0, 1}, {3, 1}, {1.5, 9})});
  const Complex from(1.4, -1);
  const Complex to(1.6, -1);
  CHECK(forest.is_wider_along(from, to, 1.5, 2.9));
  CHECK_FALSE(forest.is_wider_along(from, to, 1.5, 3.1));
  CHECK_FALSE(forest.is_wider_along(from, to, 0.9, 0.3));
  // Near the tip: 1.5 wide where it is 4 deep.
  CHECK(forest.is_wider_along({1.4, 9}, {1.6, 9}, 4, 1.45));
  CHECK_FALSE(forest.is_wider_along({1.4, 9}, {1.6, 9}, 4, 1.55));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
