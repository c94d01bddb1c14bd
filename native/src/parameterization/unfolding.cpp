#include "parameterization/unfolding.h"

#include <limits>
#include <utility>

#include "conformal/correction.h"
#include "conformal/placement.h"
#include "quality/turning_number.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {

Distortion chart_distortion(const NormalizedPatch& patch, const ComplexVector& z) {
  const auto n = static_cast<std::ptrdiff_t>(patch.triangles.size() - patch.n_virtual);
  const auto triangles = patch.triangles.begin();
  const auto weights = patch.triangle_weights.begin();
  return measure_distortion(patch.surface(), {triangles, triangles + n}, {weights, weights + n}, z);
}

UnfoldedMap unfold(const SpectralSolver& solver, const Pins& held, const ComplexVector& z, const Progress& progress) {
  const NormalizedPatch& patch = solver.patch();
  const ConformalEnergy& energy = solver.energy();
  std::vector<char> held_vertices(held.empty() ? 0 : static_cast<std::size_t>(patch.n_vertices), 0);
  for (const auto& pin : held) held_vertices[static_cast<std::size_t>(pin.first)] = 1;
  std::vector<BoundaryLoop> loops{patch.outer};
  loops.insert(loops.end(), patch.inner.begin(), patch.inner.end());
  UnfoldedMap result;
  result.mean_qc_before = z.size() > 0 ? chart_distortion(patch, z).mean_qc : std::numeric_limits<double>::quiet_NaN();
  // Pins may hold the map mirrored, which is no fold.
  const bool mirrored = !held.empty() && signed_area(energy, z) < 0;
  FoldFreeMap& map = result.fold_free;
  map = fold_free_map({energy, patch.surface(), loops, held_vertices, solver.backend()},
                      mirrored ? ComplexVector(z.conjugate()) : z, progress);
  if (mirrored) map.z = map.z.conjugate().eval();
  result.changed = map.is_embedding || map.flipped != map.flipped_before;
  result.mean_qc = result.mean_qc_before;
  if (!result.changed) return result;
  if (held.empty() && !place(map.z, energy, patch.outer, patch.surface(), energy.area() * patch.scale * patch.scale)) {
    throw SolveFailure("The map has no positive area", "add seams that make the island flatter.");
  }
  const ComplexVector whole = with_virtual_vertices(patch, map.z);
  result.turning_number = turning_number(patch.outer, patch.triangles, patch.triangle_weights, whole);
  ComplexVector r;
  const double lambda = eigen_residual(energy, quotient_form(solver.form()), whole, r);
  result.eigenvalue = lambda * solver.eigenvalue_unit(Method::spectral);
  result.residual = r.norm() / (energy.max_diagonal() * map.z.norm());
  result.mean_qc = chart_distortion(patch, map.z).mean_qc;
  return result;
}

}  // namespace spectral_conformal
