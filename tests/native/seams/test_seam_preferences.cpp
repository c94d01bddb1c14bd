#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "meshes.h"
#include "seams/seam_preferences.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("seam_preferences");

TEST_CASE("without preferences nothing changes") {
  const Mesh mesh = sphere(3);
  const SeamGraph graph(mesh.view());
  std::vector<int> same(mesh.points.size());
  for (std::size_t v = 0; v < same.size(); ++v) same[v] = static_cast<int>(v);
  for (const double factor : cost_factors({}, graph, same)) CHECK(factor == 1);
}

TEST_CASE("what looks at the viewer is dearer, up to the length of the direction") {
  const Mesh mesh = sphere(6);
  const SeamGraph graph(mesh.view());
  SeamSuggestionOptions options;
  options.front = {0, -3, 0};
  const std::vector<double> factors = cost_factors(options, graph, {});
  double highest = 0;
  for (std::size_t e = 0; e < factors.size(); ++e) {
    const auto [a, b] = graph.edges()[e].vertices;
    const double y = 0.5 * (mesh.points[a].y() + mesh.points[b].y());
    CHECK(factors[e] == doctest::Approx(1 + std::max(0.0, -3 * y)).epsilon(0.15));
    highest = std::max(highest, factors[e]);
  }
  CHECK(highest > 3.9);
  CHECK(highest <= 4);
}

TEST_CASE("painted weights change the cost up to a factor of eight either way") {
  const Mesh mesh = quad_grid(2, 1);
  const SeamGraph graph(mesh.view());
  // In the numbers of another mesh, of which this is a part.
  const std::vector<double> painted{9, 1, 1, 0, 0, -1, -1};
  SeamSuggestionOptions options;
  options.vertex_preference = painted.data();
  const std::vector<double> factors = cost_factors(options, graph, {1, 3, 5, 2, 4, 6});
  const auto factor = [&](int a, int b) { return factors[static_cast<std::size_t>(graph.find_edge(a, b))]; };
  CHECK(factor(0, 3) == doctest::Approx(0.125));
  CHECK(factor(1, 4) == doctest::Approx(1));
  CHECK(factor(2, 5) == doctest::Approx(8));
  CHECK(factor(0, 1) == doctest::Approx(1 / std::sqrt(8)));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
