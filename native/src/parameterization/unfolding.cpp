#include "parameterization/unfolding.h"

#include <limits>
#include <utility>

#include "layout/placement.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {

UnfoldedMap unfold(const SpectralSolver& solver, const Pins& held, const ComplexVector& z,
                   const UnfoldingOptions& options, const Progress& progress) {
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
  map = fold_free_map(
      {energy, patch.surface(), loops, held_vertices, solver.backend(), options.is_refused, options.moves_apart},
      mirrored ? ComplexVector(z.conjugate()) : z, progress);
  if (mirrored) map.z = map.z.conjugate().eval();
  result.changed = options.is_refused || map.is_embedding || map.flipped != map.flipped_before ||
                   map.covered_itself != map.covers_itself;
  result.mean_qc = result.mean_qc_before;
  if (!result.changed) return result;
  if (held.empty() && !solver.place(map.z)) {
    throw SolveFailure("The map has no positive area", "add seams that make the island flatter.");
  }
  const SpectralSolver::Numbers after = solver.numbers(with_virtual_vertices(patch, map.z));
  result.turning_number = map.turning_number;
  result.eigenvalue = after.eigenvalue;
  result.residual = after.residual;
  result.mean_qc = chart_distortion(patch, map.z).mean_qc;
  return result;
}

}  // namespace spectral_conformal
