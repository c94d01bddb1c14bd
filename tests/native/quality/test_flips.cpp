#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "quality/flips.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("flips");

TEST_CASE("without a tolerance the sign is exact") {
  CHECK(image_orientation(0.0, 1.0, Complex(0.3, 1e-18)) == 1);
  CHECK(image_orientation(0.0, 1.0, Complex(0.3, -1e-18)) == -1);
  CHECK(image_orientation(0.0, Complex(1, 1) / 3.0, Complex(0.7, 0.7)) == 0);
  CHECK(image_orientation(0.0, 0.0, 1.0) == 0);
}

TEST_CASE("a sine counts at every size and place, a resolution by the coordinates") {
  const FlipTolerance sine{1e-6, 0};
  const FlipTolerance resolution{0, 1e-6};
  for (const double unit : {1.0, 1e-9, 1e9}) {
    for (const double sign : {1.0, -1.0}) {
      const int expected = static_cast<int>(sign);
      CHECK(image_orientation(0.0, unit, unit * Complex(1, sign * 2e-6), sine) == expected);
      CHECK(image_orientation(0.0, unit, unit * Complex(1, sign * 0.5e-6), sine) == 0);
      CHECK(image_orientation(0.0, unit, unit * Complex(1, sign * 2e-6), resolution) == expected);
      CHECK(image_orientation(0.0, unit, unit * Complex(1, sign * 0.5e-6), resolution) == 0);
      // Ten times as far from the origin, ten times as deep.
      const Complex far = 10 * unit;
      CHECK(image_orientation(far, far + unit, far + unit * Complex(0.5, sign * 2e-6), resolution) == 0);
      CHECK(image_orientation(far, far + unit, far + unit * Complex(0.5, sign * 2e-5), resolution) == expected);
    }
  }
}

TEST_CASE("triangles of a map: flipped, collapsed, positive") {
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {0, 2, 1}, {0, 1, 1}, {1, 2, 0}};
  const ComplexVector z = (ComplexVector(3) << 0.0, 1.0, Complex(0, 1)).finished();
  CHECK(is_positive(triangles[0], z));
  CHECK(is_flipped(triangles[1], z));
  CHECK_FALSE(is_positive(triangles[2], z));
  CHECK_FALSE(is_flipped(triangles[2], z));
  CHECK(non_positive_triangles(triangles, z) == std::vector<int>{1, 2});
  // The last has half a right angle at its first corner.
  CHECK(non_positive_triangles(triangles, z, {0.9, 0}) == std::vector<int>{1, 2, 3});
  CHECK(non_positive_triangles(triangles, z, {1.1, 0}) == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("a map that is mirrored as a whole is mirrored back") {
  const Patch patch(quad_grid(4, 3));
  const ComplexVector z = flat_map(patch.positions);
  CHECK(positively_oriented(patch.chart.triangles, patch.chart.triangle_weights, z) == z);
  CHECK(positively_oriented(patch.chart.triangles, patch.chart.triangle_weights, z.conjugate()) == z);
  CHECK(non_positive_triangles(patch.chart.triangles, z).empty());
  CHECK(non_positive_triangles(patch.chart.triangles, z.conjugate()).size() == patch.chart.triangles.size());
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
