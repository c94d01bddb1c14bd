#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "injective/fold_free_map.h"
#include "mesh/boundary_loops.h"
#include "meshes.h"
#include "quality/turning_number.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

struct Input {
  Patch patch;
  ConformalEnergy energy;
  std::vector<BoundaryLoop> loops;
  std::vector<char> held;

  explicit Input(const Mesh& mesh)
      : patch(mesh), energy(patch.energy(Weights::uniform)), loops(patch.chart.boundary_loops) {
    std::swap(loops.front(), loops[static_cast<std::size_t>(outer_loop(loops, patch.positions))]);
  }
  FoldFreeMap solve(const ComplexVector& z, const Progress& progress = {}) const {
    return fold_free_map({energy, patch.positions, loops, held}, z, progress);
  }
  FoldFreeMap solve_apart(const ComplexVector& z, double sizes) const {
    return fold_free_map({energy, patch.positions, loops, held, FactorizationBackend::automatic, false, true, sizes},
                         z);
  }
  /// The energy at the mean scale of the surface.
  double isometric_energy(const ComplexVector& z) const {
    const auto elements = patch.elements();
    return energy_of(elements, DistortionMeasure::symmetric_dirichlet, mean_scale_factor(elements, z) * z);
  }
  /// Whether both triangles of every face's first split, and all other triangles, are counterclockwise.
  bool is_fold_free(const ComplexVector& z) const {
    for (std::size_t t = 0; t < patch.chart.triangles.size(); ++t) {
      const auto& [a, b, c] = patch.chart.triangles[t];
      if (!(std::imag(std::conj(z[b] - z[a]) * (z[c] - z[a])) > 0)) return false;
      if (patch.chart.triangle_weights[t] != 1.0 && t % 4 == 1) t += 2;
    }
    return turning_number(loops.front(), patch.chart.triangles, patch.chart.triangle_weights, z) == 1;
  }
};

/// Three triangles around an inner vertex that stands aside (Floater, Parametric Tilings and Scattered Data
/// Approximation, 1998): beyond -1 the conformal map folds one of them.
Mesh floater(double offset) {
  return Mesh({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, offset, 1}}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

}  // namespace

TEST_SUITE_BEGIN("fold_free_map");

TEST_CASE("a map without folds is returned as it is") {
  const Input input(bumpy_grid(8, 6));
  const ComplexVector z = conformal_map(input.patch);
  const FoldFreeMap map = input.solve(z);
  CHECK(map.z == z);
  CHECK(map.flipped_before == 0);
  CHECK_FALSE(map.is_embedding);
  CHECK_FALSE(map.relaxation);
  CHECK(map.is_locally_injective);
}

TEST_CASE("Floater's three triangles are unfolded in place") {
  for (const double offset : {-1.0, -2.0, -5.0}) {
    const Input input(floater(offset));
    const ComplexVector z = conformal_map(input.patch);
    const FoldFreeMap map = input.solve(z);
    CHECK(map.flipped_before >= 1);
    CHECK(map.flipped == 0);
    CHECK(map.is_locally_injective);
    CHECK(input.is_fold_free(map.z));
  }
}

TEST_CASE("an embedding replaces a map that winds around twice inside") {
  // z^2 on a grid around 0: no flip, but its boundary and the triangles at 0 wind around twice.
  Mesh mesh = flat_grid(8, 8);
  for (auto& p : mesh.points) p -= Eigen::Vector3d(4, 4, 0);
  mesh.points[40] = {0, 0, 0};
  const Input input(mesh);
  ComplexVector z = flat_map(input.patch.positions);
  for (Complex& value : z) value *= value;
  const FoldFreeMap map = input.solve(z);
  CHECK(map.is_embedding);
  REQUIRE(map.relaxation);
  CHECK(map.relaxation->status == RelaxationStatus::converged);
  CHECK(map.relaxation->energy < map.relaxation->energy_before);
  CHECK(map.is_locally_injective);
  CHECK(input.is_fold_free(map.z));
  // The patch is flat: relaxed, the embedding is nearly a similarity.
  CHECK(difference_up_to_similarity(map.z, flat_map(input.patch.positions)) < 0.05);
}

TEST_CASE("without a map, with holes and with quads there is an embedding, nearly as good as the conformal map") {
  for (const Mesh& mesh : {bumpy_grid(10, 8), perforated_grid(12, 9), quad_grid(6, 5), spiky_grid(2, 1.0)}) {
    const Input input(mesh);
    const FoldFreeMap map = input.solve({});
    CHECK(map.is_embedding);
    CHECK(map.is_locally_injective);
    CHECK(input.is_fold_free(map.z));
    const auto mean = [&](const ComplexVector& z) {
      return measure_distortion(input.patch.positions, input.patch.chart.triangles, input.patch.chart.triangle_weights,
                                z)
          .mean_qc;
    };
    CHECK(mean(map.z) < mean(conformal_map(input.patch)) + 0.05);
  }
}

TEST_CASE("where sizes count, an embedding keeps them, and its boundary off itself") {
  for (const Mesh& mesh : {bumpy_grid(10, 8), spiky_grid(2, 1.0)}) {
    const Input input(mesh);
    double last = 1e300;
    for (const double sizes : {0.0, 0.5, 1.0}) {
      const FoldFreeMap map = input.solve_apart({}, sizes);
      CHECK((map.is_embedding && map.is_locally_injective && !map.covers_itself));
      CHECK(input.is_fold_free(map.z));
      const double energy = input.isometric_energy(map.z);
      CHECK(energy < last);
      last = energy;
    }
  }
}

TEST_CASE("held vertices stay, and no embedding replaces them") {
  Input input(flat_grid(5, 5));
  ComplexVector z = flat_map(input.patch.positions);
  z[14] += Complex(2.0, 0);
  input.held.assign(static_cast<std::size_t>(z.size()), 1);
  const FoldFreeMap map = input.solve(z);
  CHECK(map.flipped > 0);
  CHECK_FALSE(map.is_embedding);
  CHECK(map.z == z);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
