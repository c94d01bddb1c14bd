#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "parameterization/normalized_patch.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("normalized_patch");

TEST_CASE("any unit and place give the same numbers, and the scale leads back") {
  const Patch patch(bumpy_grid(6, 5));
  const NormalizedPatch expected = normalized_patch(patch.chart, patch.positions, false);
  CHECK((expected.positions.colwise().maxCoeff() - expected.positions.colwise().minCoeff()).maxCoeff() ==
        doctest::Approx(1));
  CHECK((expected.positions.colwise().maxCoeff() + expected.positions.colwise().minCoeff()).norm() < 1e-14);
  Positions moved = 1024 * patch.positions;
  const NormalizedPatch scaled = normalized_patch(patch.chart, moved, false);
  CHECK(scaled.positions == expected.positions);
  CHECK(scaled.scale == 1024 * expected.scale);
  CHECK(expected.outer == patch.outer());
  CHECK(expected.inner.empty());
}

TEST_CASE("holes are filled behind the chart's own triangles and vertices") {
  const Patch patch(perforated_grid(7, 7));
  const NormalizedPatch open = normalized_patch(patch.chart, patch.positions, false);
  CHECK(open.inner.size() == 4);
  CHECK((open.n_virtual == 0 && open.positions.rows() == open.n_vertices));
  const NormalizedPatch filled = normalized_patch(patch.chart, patch.positions, true);
  CHECK(filled.n_virtual > 0);
  CHECK(filled.triangles.size() == open.triangles.size() + filled.n_virtual);
  CHECK(filled.triangle_weights.size() == filled.triangles.size());
  CHECK(filled.surface() == open.positions);
}

TEST_CASE("added vertices of a map lie at the mean of their neighbors") {
  // A hexagonal hole gets a vertex in its middle.
  Mesh mesh;
  for (const double radius : {1.0, 2.0}) {
    for (int k = 0; k < 6; ++k) {
      const double angle = 3.14159265358979323846 / 3 * k;
      mesh.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  }
  for (int k = 0; k < 6; ++k) mesh.add({k, 6 + k, 6 + (k + 1) % 6, (k + 1) % 6});
  const Patch patch(mesh);
  const NormalizedPatch filled = normalized_patch(patch.chart, patch.positions, true);
  REQUIRE(filled.positions.rows() == 13);
  const ComplexVector z = random_map(12);
  const ComplexVector whole = with_virtual_vertices(filled, z);
  CHECK(whole.head(12) == z);
  CHECK(std::abs(whole[12] - z.head(6).mean()) < 1e-15);
}

TEST_CASE("a border that goes over itself lets a map cover itself") {
  // A strip of eleven squares, bent around by somewhat less, and by somewhat more, than a whole turn.
  const Patch patch(bumpy_grid(12, 2));
  const NormalizedPatch strip = normalized_patch(patch.chart, patch.positions, false);
  const auto bent = [&](double turns) {
    ComplexVector z(patch.positions.rows());
    const double width = patch.positions.col(0).maxCoeff() - patch.positions.col(0).minCoeff();
    for (Eigen::Index v = 0; v < z.size(); ++v) {
      const double along = (patch.positions(v, 0) - patch.positions.col(0).minCoeff()) / width;
      const double radius = patch.positions(v, 1) > patch.positions.col(1).mean() ? 1 : 2;
      z[v] = std::polar(radius, 6.283185307179586 * turns * along);
    }
    return z;
  };
  CHECK_FALSE(may_cover_itself(strip, bent(0.9)));
  CHECK(may_cover_itself(strip, bent(1.2)));
  CHECK(n_covering_triangles(strip, bent(0.9)) == 0);
  CHECK(n_covering_triangles(strip, bent(1.2)) > 4);
}

TEST_CASE("a chart that is not a disk is refused") {
  Mesh mesh = bumpy_grid(3, 3);
  const Patch patch(mesh);
  Positions broken = patch.positions;
  broken(4, 1) = std::nan("");
  CHECK_THROWS_AS(normalized_patch(patch.chart, broken, false), InvalidMesh);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
