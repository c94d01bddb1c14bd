#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "injective/tutte_embedding.h"
#include "mesh/boundary_loops.h"
#include "meshes.h"

namespace spectral_conformal::test {
namespace {

ComplexVector embed(const Patch& patch, FactorizationBackend backend = FactorizationBackend::automatic) {
  const auto& loops = patch.chart.boundary_loops;
  return tutte_embedding(patch.chart.triangles, loops, outer_loop(loops, patch.positions), patch.positions, backend,
                         {});
}

/// A tube closed at its far end: `rings` rings of `sides` vertices each, as high as wide.
Mesh finger(int sides, int rings) {
  Mesh mesh;
  const double step = 2 * pi / sides;
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sides; ++k) mesh.points.emplace_back(std::cos(k * step), std::sin(k * step), ring * step);
  }
  mesh.points.emplace_back(0, 0, rings * step);
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < sides; ++k) {
      const int a = ring * sides + k;
      const int b = ring * sides + (k + 1) % sides;
      if (ring + 1 == rings) {
        mesh.add({a, b, rings * sides});
      } else {
        mesh.add({a, b, b + sides});
        mesh.add({a, b + sides, a + sides});
      }
    }
  }
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("tutte_embedding");

TEST_CASE("no triangle is flipped; the outer loop is on the circle, everything else within") {
  for (const Mesh& mesh : {bumpy_grid(9, 7), perforated_grid(12, 9), finger(6, 5), flat_grid(1, 30)}) {
    const Patch patch(mesh);
    for (const auto backend : backends()) {
      const ComplexVector z = embed(patch, backend);
      CHECK(z.size() == patch.positions.rows());
      CHECK(count_flipped(patch, z) == 0);
      std::vector<char> on_circle(static_cast<std::size_t>(z.size()), 0);
      for (const int v : patch.outer()) on_circle[v] = 1;
      for (Eigen::Index v = 0; v < z.size(); ++v) {
        if (on_circle[static_cast<std::size_t>(v)]) {
          CHECK(std::abs(z[v]) == doctest::Approx(1));
        } else {
          CHECK(std::abs(z[v]) < 1);
        }
      }
    }
  }
}

TEST_CASE("distances on the circle are those in 3D, to a scale") {
  const Patch patch(bumpy_grid(6, 5));
  const ComplexVector z = embed(patch);
  const BoundaryLoop& loop = patch.outer();
  const double length = loop_length(loop, patch.positions);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const int a = loop[i];
    const int b = loop[(i + 1) % loop.size()];
    const double angle = std::arg(std::conj(z[a]) * z[b]);
    CHECK(angle == doctest::Approx(2 * pi * (patch.positions.row(b) - patch.positions.row(a)).norm() / length));
  }
}

TEST_CASE("limbs that equal weights shrink beyond double precision are embedded, too") {
  // By equal weights the rings shrink by about exp(-2 pi / 5) each: to 1e-14 and 1e-55.
  for (const int rings : {30, 100}) {
    const Patch patch(finger(5, rings));
    CHECK(count_flipped(patch, embed(patch)) == 0);
  }
}

TEST_CASE("edges without length have a place of their own") {
  Mesh mesh = bumpy_grid(5, 4);
  mesh.points[1] = mesh.points[2];
  mesh.points[9] = mesh.points[8];
  const Patch patch(mesh);
  CHECK(count_flipped(patch, embed(patch)) == 0);
}

TEST_CASE("a loop without length gets equal arcs") {
  Mesh mesh = finger(6, 5);
  for (std::size_t k = 0; k < 6; ++k) mesh.points[k] = {0, 0, 0};
  const Patch patch(mesh);
  const ComplexVector z = embed(patch);
  REQUIRE(z.allFinite());
  CHECK(count_flipped(patch, z) == 0);
  const BoundaryLoop& loop = patch.outer();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    CHECK(std::arg(std::conj(z[loop[i]]) * z[loop[(i + 1) % loop.size()]]) == doctest::Approx(2 * pi / 6));
  }
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
