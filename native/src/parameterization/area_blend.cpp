#include "parameterization/area_blend.h"

#include <utility>

#include "parameterization/report.h"
#include "parameterization/unfolding.h"

namespace spectral_conformal {

AreaBlend blend_area(const SpectralSolver& solver, double amount, const Progress& progress) {
  const NormalizedPatch& patch = solver.patch();
  const ConformalEnergy& energy = solver.energy();
  Timings timings;  // all of it is the blend's
  SpectralMap conformal =
      SpectralSolver(solver, energy.weights(), solver.boundary()).solve({}, {}, part(progress, 0.0, 0.2), timings);
  if (conformal.rejection != Rejection::none) throw failure_of(conformal, {});
  AreaBlend result;
  result.scale_deviation_before = chart_distortion(patch, conformal.z).log2_scale_deviation;
  result.relaxed = relax_to_isometry(patch.triangles, energy.energy_shapes(), patch.triangle_weights, patch.n_virtual,
                                     std::move(conformal.whole), solver.backend(), {}, part(progress, 0.2, 1.0));
  const ComplexVector& z = result.relaxed.z;
  result.metric.reserve(patch.triangles.size());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const auto& [a, b, c] = patch.triangles[t];
    result.metric.push_back(blend(metric_of_map(energy.energy_shapes()[t], z[b] - z[a], z[c] - z[a]), amount));
  }
  return result;
}

}  // namespace spectral_conformal
