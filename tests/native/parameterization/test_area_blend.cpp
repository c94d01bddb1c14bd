#include <doctest/doctest.h>

#include "meshes.h"
#include "parameterization/area_blend.h"
#include "parameterization/unfolding.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("area_blend");

TEST_CASE("the full blend's metric is that of the relaxed map, none's is the identity") {
  const Patch patch(bumpy_grid(8, 6));
  const NormalizedPatch normalized = normalized_patch(patch.chart, patch.positions, false);
  SpectralSolver solver(normalized, Weights::uniform, BoundaryMeasure::length, FactorizationBackend::automatic);
  const AreaBlend none = blend_area(solver, 0, {});
  for (const TriangleMetric& g : none.metric) CHECK((g.xx == 1 && g.xy == 0 && g.yy == 1));
  const AreaBlend full = blend_area(solver, 1, {});
  CHECK(full.metric.size() == patch.chart.triangles.size());
  CHECK(full.relaxed.status == RelaxationStatus::converged);
  CHECK(full.scale_deviation_before > chart_distortion(normalized, full.relaxed.z).log2_scale_deviation);
  solver.stretch(full.metric);
  CHECK(solver.energy().value(full.relaxed.z) < 1e-20);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
