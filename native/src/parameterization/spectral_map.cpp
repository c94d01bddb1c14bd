#include "parameterization/spectral_map.h"

#include <utility>

#include "conformal/eigenproblem.h"
#include "parameterization/constrained_map.h"
#include "parameterization/map_check.h"

namespace spectral_conformal {

SpectralProblem spectral_problem(std::shared_ptr<const NormalizedPatch> patch, Weights weights,
                                 BoundaryMeasure boundary, FactorizationBackend backend) {
  // L = L_D - A, the conformal energy (Eq. 2 and 3).
  ConformalEnergy energy =
      conformal_energy(patch->positions, patch->triangles, patch->triangle_weights, weights, patch->n_virtual);
  // B, the mass of the boundary without the constants (Eq. 5).
  BoundaryForm form = form_of(*patch, boundary);
  return {std::move(patch), boundary, backend, std::move(energy), std::move(form)};
}

SpectralMap spectral_map(SpectralProblem& problem, const SolveOptions& options, const Pins& attractors,
                         const Attempt& attempt, const Progress& progress, Timings& timings) {
  Stopwatch watch(timings);
  SpectralMap map;
  const bool is_constrained = !options.constraints.empty();

  // L of L z = lambda B z: the conformal energy (Eq. 2 and 3), of symmetric maps if the equations mirror the patch.
  const ConformalEnergy& energy = problem.energy_under(options.constraints);

  // B: the form of the boundary (Eq. 5) with soft constraints (section 4.2), or A (section 3.3), or the identity (Eq.
  // 4).
  const BoundaryForm mass = problem.mass(options.method);
  const QuotientForm form = quotient_form(problem, options, attractors);

  EigenproblemOptions eigen = attempt.options;
  eigen.tolerance *= options.tolerance;
  const bool is_soft = options.has_extenders_or_rigidity() || !attractors.empty();
  Eigenvector v;
  double begun = 0;
  for (double shift = problem.needs_least_shift ? attempt.least_shift : attempt.relative_shift;;
       shift = attempt.least_shift) {
    const double factored = begun + 0.6 * (1 - begun);
    // The factor of L + s M (section 3.4, with M in place of the identity), on the maps z = P w of the equations.
    ReducedFactor& factor = problem.factorized(options, shift, part(progress, begun, factored));
    watch.lap("factorization");
    map.shift = factor.shift();
    map.rejection = factor.is_factored() ? Rejection::none : Rejection::not_factorized;
    if (map.rejection != Rejection::none) return map;

    // z of the smallest nonzero lambda of L z = lambda B z, as that of the largest mu of B z = mu (L + s M) z (Eq. 7).
    EarlierBasis none;
    EarlierBasis& basis = is_constrained ? problem.earlier.constrained : is_soft ? problem.earlier.free : none;
    const ComplexVector earlier = is_soft && !is_constrained ? problem.earlier.z : ComplexVector();
    eigen.may_lower_shift = attempt.least_shift < shift;
    const int solves = v.solves;
    begun = eigen.may_lower_shift ? 0.8 : 1.0;
    v = smallest_eigenvector(factor, energy, form, mass, eigen, basis, earlier, part(progress, factored, begun));
    v.solves += solves;
    watch.lap("eigenproblem");
    if (!v.is_shift_too_large) break;
    problem.needs_least_shift = true;
  }
  map.solves = v.solves;
  map.residual = v.residual;
  map.eigenvalue = v.lambda * eigenvalue_unit(problem, options.method);

  // Check it.
  map.rejection = v.converged ? Rejection::none : Rejection::not_converged;
  if (map.rejection != Rejection::none) return map;
  MapCheck check = measured_check(problem, v.z);
  if (is_constrained) check = with_folds(*problem.patch, v.z, check);
  check.eigenvalue = v.lambda;
  check.error = v.change;
  check.error_limit = v.change_limit;
  check.must_wind_once = options.method == Method::spectral;
  map.turning_number = check.turning_number;
  map.flipped = check.flipped;
  map.rejection = check_map(v.z, check);
  if (map.rejection == Rejection::none || map.rejection == Rejection::winding) map.whole = std::move(v.z);
  if (map.rejection != Rejection::none) return map;
  if (!is_constrained) problem.earlier.z = map.whole;
  watch.lap("eigenproblem");
  return map;
}

SpectralMap placed_map(const SpectralProblem& problem, SpectralMap map, Timings& timings) {
  if (map.rejection != Rejection::none || map.z.size() > 0) return map;
  Stopwatch watch(timings);
  map.z = map.whole.head(problem.patch->n_vertices);
  place(problem, map.z);
  watch.lap("placement");
  return map;
}

}  // namespace spectral_conformal
