#include "parameterization/spectral_problem.h"

#include <utility>

#include "conformal/mirrored_energy.h"
#include "conformal/pin_attraction.h"
#include "layout/placement.h"
#include "mesh/boundary_loops.h"
#include "quality/turning_number.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {

BoundaryForm SpectralProblem::mass(Method method) const {
  return method == Method::fiedler ? identity_form(patch->n_vertices) : form;
}

void SpectralProblem::factorize(Method method, double requested_shift, const Progress& progress) {
  const bool is_fiedler = method == Method::fiedler;
  if (is_factored() && relative_shift == requested_shift && is_factor_of_fiedler == is_fiedler) return;
  // The structure of L does not depend on what is added to its diagonal.
  std::unique_ptr<Factorization> analyzed = factor.release();
  drop_factor();
  factor = ReducedFactor::of(energy.matrix(), std::nullopt, mass(method), patch->positions, requested_shift, backend,
                             progress, std::move(analyzed));
  relative_shift = requested_shift;
  is_factor_of_fiedler = is_fiedler;
}

ReducedFactor& SpectralProblem::factorized(const SolveOptions& options, double requested_shift,
                                           const Progress& progress) {
  if (options.constraints.empty()) {
    factorize(options.method, requested_shift, progress);
    return factor;
  }
  const ConformalEnergy& own = energy_under(options.constraints);
  LinearConstraints constraints = LinearConstraints::of(options.constraints, energy.n_vertices());
  if (!restricted_factor || !restricted_factor->serves(constraints, requested_shift)) {
    restricted_factor.reset();  // before the next one takes memory
    earlier.constrained = {};
    restricted_factor = std::make_unique<ReducedFactor>(ReducedFactor::of(
        own.matrix(), std::move(constraints), form, patch->positions, requested_shift, backend, progress));
  }
  return *restricted_factor;
}

void SpectralProblem::drop_factor() {
  factor = {};
  earlier = {};
  drop_restricted_factor();
}

void SpectralProblem::drop_restricted_factor() {
  restricted_factor = {};
  mirrored_energy = {};
  mirror_images = {};
}

const ConformalEnergy& SpectralProblem::energy_under(const LinearEquations& equations) {
  if (equations.empty()) return energy;
  std::vector<int> image = spectral_conformal::mirror_images(equations, energy.n_vertices());
  if (image != mirror_images) {
    drop_restricted_factor();
    if (!image.empty()) {
      mirrored_energy =
          std::make_unique<ConformalEnergy>(spectral_conformal::mirrored_energy(energy, patch->positions, image));
    }
    mirror_images = std::move(image);
  }
  return mirrored_energy ? *mirrored_energy : energy;
}

void SpectralProblem::stretch(const std::vector<TriangleMetric>& metric) {
  energy.stretch(metric);
  drop_factor();
}

int SpectralProblem::clamp(double min_relative_height) {
  drop_factor();
  return energy.clamp(min_relative_height);
}

bool has_form(const NormalizedPatch& patch, BoundaryMeasure boundary) {
  return boundary == BoundaryMeasure::vertex || loop_length(patch.outer, patch.positions) > 0;
}

BoundaryForm form_of(const NormalizedPatch& patch, BoundaryMeasure boundary) {
  if (!has_form(patch, boundary)) throw InvalidMesh(Rejection::loop_without_length);
  return boundary_form(patch.outer, patch.positions, boundary);
}

SpectralProblem other_problem(const SpectralProblem& like, Weights weights, BoundaryMeasure boundary) {
  return {like.patch, boundary, like.backend, like.energy.with(weights), form_of(*like.patch, boundary)};
}

QuotientForm quotient_form(const SpectralProblem& problem, const SolveOptions& options, const Pins& attractors) {
  if (options.method == Method::area) return QuotientForm::area(problem.energy);
  QuotientForm form(problem.mass(options.method));
  const double hole_rigidity = options.hole_rigidity.value_or(0);
  if (hole_rigidity != 0) {
    for (const BoundaryLoop& loop : problem.patch->inner) {
      const BoundaryForm spread = boundary_form(loop, problem.patch->positions, problem.boundary);
      if (!spread.vertices.empty()) form.add_spread(spread, hole_rigidity);
    }
  }
  // While one has an effect, the others belong to the support, so that the next solve can start from this one.
  if (options.has_extenders()) {
    for (const Extender& extender : options.extenders) form.add_extender(extender);
  }
  if (!attractors.empty()) {
    const bool may_turn = options.constraints.empty();
    form.add_attraction(pin_attraction(attractors, problem.form, options.soft_pins, may_turn));
  }
  return form;
}

double eigenvalue_unit(const SpectralProblem& problem, Method method) {
  if (method == Method::area) return 1;
  // positions = input / scale. Lengths, and hence M, are divided by scale; L has weight_unit / |T|.
  const double scale = problem.patch->scale;
  const bool uniform = problem.energy.weights() == Weights::uniform;
  const double energy_unit = uniform ? 1 : problem.energy.weight_unit() * scale * scale;
  const bool by_length = method != Method::fiedler && problem.boundary == BoundaryMeasure::length;
  return (by_length ? 1 / scale : 1) / energy_unit;
}

MapNumbers map_numbers(const SpectralProblem& problem, const ComplexVector& z) {
  const NormalizedPatch& patch = *problem.patch;
  const ConformalEnergy& energy = problem.energy;
  MapNumbers result;
  result.turning_number = turning_number(patch.outer, patch.triangles, patch.triangle_weights, z);
  ComplexVector r;
  const double lambda = eigen_residual(energy, QuotientForm(problem.form), z, r);
  result.eigenvalue = lambda * eigenvalue_unit(problem, Method::spectral);
  const double max_diagonal = problem.is_factored() ? problem.factor.max_diagonal() : energy.max_diagonal();
  result.residual = r.norm() / (max_diagonal * z.norm());
  return result;
}

MapCheck measured_check(const SpectralProblem& problem, const ComplexVector& z) {
  MapCheck check;
  if (!z.allFinite()) return check;
  const NormalizedPatch& patch = *problem.patch;
  check.turning_number = turning_number(patch.outer, patch.triangles, patch.triangle_weights, z);
  check.area = signed_area(problem.energy, z);
  return check;
}

bool place(const SpectralProblem& problem, ComplexVector& z) {
  const NormalizedPatch& patch = *problem.patch;
  return place(z, problem.energy, patch.outer, patch.surface(), problem.energy.area() * patch.scale * patch.scale);
}

}  // namespace spectral_conformal
