#include <doctest/doctest.h>

#include "layout/island_outline.h"

namespace spectral_conformal::test {
namespace {

/// Two triangles of the unit square, the second clockwise or not, as islands of the given numbers.
std::vector<IslandOutline> square_outlines(bool flips, int second) {
  ComplexVector points(4);
  points << Complex(0, 0), Complex(1, 0), Complex(1, 1), Complex(0, 1);
  const std::vector<int> corners = flips ? std::vector<int>{0, 1, 2, 0, 3, 2} : std::vector<int>{0, 1, 2, 0, 2, 3};
  return island_outlines(points, {0, 3, 6}, corners, {0, second}, 2);
}

}  // namespace

TEST_SUITE_BEGIN("island_outline");

TEST_CASE("edges inside of an island cancel, also between faces wound differently") {
  for (const bool flips : {false, true}) {
    const auto outlines = square_outlines(flips, 0);
    CHECK(outlines[0].edges.size() == 4);
    CHECK(outlines[0].area == doctest::Approx(1));
    CHECK(outlines[1].edges.empty());
  }
}

TEST_CASE("edges between islands stay, and faces that are left out add none") {
  CHECK(square_outlines(false, 1)[0].edges.size() == 3);
  CHECK(square_outlines(false, 1)[1].edges.size() == 3);
  CHECK(square_outlines(false, -1)[1].edges.empty());
}

TEST_CASE("a face that is a line still takes space") {
  ComplexVector points(3);
  points << Complex(0, 0), Complex(1, 0), Complex(2, 0);
  CHECK_FALSE(island_outlines(points, {0, 3}, {0, 1, 2}, {0}, 1)[0].edges.empty());
}

TEST_CASE("an outline added after a mirroring still winds counterclockwise") {
  auto outlines = square_outlines(false, 0);
  IslandOutline both = outlines[0];
  add(both, outlines[0], {1, true, {3, 0}});
  double twice_area = 0;
  for (const OutlineEdge& edge : both.edges) twice_area += (std::conj(edge.from) * edge.to).imag();
  CHECK(twice_area == doctest::Approx(4));
  CHECK(hull_of(both).size() == 6);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
