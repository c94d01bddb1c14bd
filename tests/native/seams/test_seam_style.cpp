#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "meshes.h"
#include "seams/seam_preferences.h"
#include "seams/seam_style.h"

namespace spectral_conformal::test {
namespace {

/// The factors on the costs of a cube's edges, seen from above.
std::vector<double> factors_on_cube(SeamStyle style, double front) {
  const Mesh mesh = cell_surface(1, [](int, int, int) { return true; });
  const MirroredPieces parts = MirroredPieces::of(mesh.view());
  std::vector<int> numbers(mesh.points.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  SeamSuggestionOptions options;
  options.style = style;
  options.front = {0, 0, front};
  const SeamPreferences preferences(options, parts.symmetry, numbers);
  return preferences.cost_factors(SeamGraph::of(parts.pieces[0].view()), parts.pieces[0], false);
}

}  // namespace

TEST_SUITE_BEGIN("seam_style");

TEST_CASE("the front is twice as dear to organic seams") {
  for (const SeamStyle style : {SeamStyle::hard, SeamStyle::organic}) {
    for (const double factor : factors_on_cube(style, 0)) CHECK(factor == 1);
  }
  const auto highest = [](SeamStyle style) {
    const std::vector<double> seen = factors_on_cube(style, 3);
    return *std::max_element(seen.begin(), seen.end());
  };
  const double above = 3 * std::sqrt(0.5);
  CHECK(highest(SeamStyle::hard) == doctest::Approx(1 + above));
  CHECK(highest(SeamStyle::organic) == doctest::Approx(1 + 2 * above));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
