#include <doctest/doctest.h>

#include <cmath>

#include "meshes.h"
#include "parameterization/unfolding.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("unfolding");

TEST_CASE("a map without folds is left as it is, one with a fold is unfolded, none is replaced by an embedding") {
  const Patch patch(bumpy_grid(6, 6));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  Timings timings;
  const ComplexVector z = solver.solve({}, {}, {}, timings).z;
  const UnfoldedMap same = unfold(solver, {}, z, {}, {});
  CHECK_FALSE(same.changed);
  CHECK(same.mean_qc == same.mean_qc_before);
  ComplexVector flipped = z;
  flipped[24] += 1.5 * (z[25] - z[24]);
  const UnfoldedMap unfolded = unfold(solver, {}, flipped, {}, {});
  CHECK(unfolded.changed);
  CHECK_FALSE(unfolded.fold_free.is_embedding);
  CHECK(unfolded.fold_free.flipped_before > 0);
  CHECK(unfolded.fold_free.flipped == 0);
  CHECK(unfolded.turning_number == 1);
  CHECK(unfolded.mean_qc == doctest::Approx(chart_distortion(normalized, unfolded.fold_free.z).mean_qc));
  CHECK(unfolded.eigenvalue > 0);
  const UnfoldedMap embedded = unfold(solver, {}, {}, {}, {});
  CHECK((embedded.changed && embedded.fold_free.is_embedding));
  CHECK(std::isnan(embedded.mean_qc_before));
}

TEST_CASE("distortion is that of the surface, without virtual triangles") {
  const Patch patch(perforated_grid(7, 7));
  const NormalizedPatch open = normalized_patch(patch.chart, patch.positions, false);
  const NormalizedPatch filled = normalized_patch(patch.chart, patch.positions, true);
  const ComplexVector z = flat_map(patch.positions);
  CHECK(chart_distortion(filled, z).qc == chart_distortion(open, z).qc);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
