#include "parameterization/spectral_solver.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "conformal/correction.h"
#include "conformal/davidson.h"
#include "conformal/eigenproblem.h"
#include "conformal/extended_form.h"
#include "conformal/pin_attraction.h"
#include "conformal/start_vector.h"
#include "layout/placement.h"
#include "mesh/boundary_loops.h"
#include "quality/turning_number.h"
#include "relaxation/polish.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {

namespace {

/// The reduced equation must hold at least this well before the corrections, whatever tolerance was asked for: on flat
/// patches, where lambda vanishes, rounding leaves about 1e-16 / relative_shift = 1e-4, which they then take out.
constexpr double eigenproblem_residual_limit = 1e-3;

/// s of the first attempt: well above the 1e-16 that rounding takes from the diagonal of L, well below the lambda of a
/// patch of a million vertices.
constexpr double first_relative_shift = 1e-12;

/// Ends whole corrections: where the rounding of the residual begins.
constexpr double negligible_change = 1e-10;

/// Ends steps of exact length: a tenth of what counts as resolved, since each leaves up to 0.9 of the error, and above
/// the 1e-9 where rounding ends them.
constexpr double negligible_exact_step = 0.1 * resolved_change;

/// B of Eq. 5. Throws InvalidMesh where it is zero.
BoundaryForm form_of(const NormalizedPatch& patch, BoundaryMeasure boundary) {
  if (!SpectralSolver::has_form(patch, boundary)) {
    throw InvalidMesh("The island's longest boundary loop has no length; clean up its coincident vertices.");
  }
  return boundary_form(patch.outer, patch.positions, boundary);
}

}  // namespace

/// What each attempt at the same eigenproblem changes.
struct SpectralSolver::Attempt {
  double relative_shift;  ///< see factor_shifted
  unsigned start;
  int krylov_dimension;
  int max_restarts;  ///< of Lanczos on the boundary
  double tolerance_factor;
  bool exact_steps;  ///< corrections of exact length where whole ones do not converge
};

/// Of Eq. 5, virtual vertices included, at no particular place and scale.
struct SpectralSolver::Eigenvector {
  ComplexVector z;
  double lambda = 0;    ///< z^H L z / z^H B z
  double residual = 0;  ///< see SolveRecord
  double change = 0;    ///< the last correction, relative to z
  double change_limit = resolved_change;
  int solves = 0;
  bool converged = false;
};

SpectralSolver::SpectralSolver(const NormalizedPatch& patch, Weights weights, BoundaryMeasure boundary,
                               FactorizationBackend backend)
    : patch_(&patch),
      backend_(backend),
      boundary_(boundary),
      energy_(std::make_unique<ConformalEnergy>(patch.positions, patch.triangles, patch.triangle_weights, weights,
                                                patch.n_virtual)),  // Eq. 2 and 3
      form_(form_of(patch, boundary)) {}

SpectralSolver::SpectralSolver(const SpectralSolver& like, Weights weights, BoundaryMeasure boundary)
    : patch_(like.patch_),
      backend_(like.backend_),
      boundary_(boundary),
      energy_(std::make_unique<ConformalEnergy>(*like.energy_, weights)),
      form_(form_of(*patch_, boundary)) {}

bool SpectralSolver::has_form(const NormalizedPatch& patch, BoundaryMeasure boundary) {
  return boundary == BoundaryMeasure::vertex || loop_length(patch.outer, patch.positions) > 0;
}

SpectralMap SpectralSolver::solve(const SolveOptions& options, const Pins& attractors, const Progress& progress,
                                  Timings& timings) {
  // The first passes nearly always. The second gives way to rounding: it begins with a hundred times the shift, a start
  // without preferred shape, four times the directions, asks for a tenth of the error, and measures its corrections.
  constexpr Attempt attempts[] = {{first_relative_shift, 0, 6, 20, 1.0, false}, {1e-10, 1, 24, 200, 0.1, true}};
  SpectralMap map;
  int made = 0;
  for (const Attempt& attempt : attempts) {
    // The fraction done only rises: a failed attempt has used it up.
    const Progress rest = [&progress](double, const char* phase) { return !progress || progress(1.0, phase); };
    map = this->attempt(options, attractors, attempt, made == 0 ? progress : rest, timings);
    map.attempts = ++made;
    // Without a factor the shift has been raised as far as it may be.
    if (map.rejection == Rejection::none || map.rejection == Rejection::not_factorized) break;
    if (!options.second_attempt) break;
    // A strongly negative extender has such maps as its true optimum, so that another attempt would end there too: the
    // pair meets where the map branches.
    if (map.rejection == Rejection::winding && options.has_extenders_or_rigidity()) break;
  }
  return map;
}

SpectralMap SpectralSolver::attempt(const SolveOptions& options, const Pins& attractors, const Attempt& attempt,
                                    const Progress& progress, Timings& timings) {
  Stopwatch watch(timings);
  SpectralMap map;

  // B: of the boundary (Eq. 5), or the identity, which makes z the Fiedler vector of L (Eq. 4).
  const bool on_boundary = options.method != Method::fiedler;
  const BoundaryForm identity = on_boundary ? BoundaryForm{} : identity_form(patch_->n_vertices);
  const BoundaryForm& form = on_boundary ? form_ : identity;

  // The factor of L + s M (Eq. 7): one at a time, kept where M is that of the boundary.
  ShiftedFactor own;
  ShiftedFactor& factor = on_boundary ? factor_ : own;
  if (!on_boundary) {
    own = factored(form, attempt.relative_shift, part(progress, 0.0, 0.6));
    watch.lap("factorization");
  } else if (!is_factored() || relative_shift_ != attempt.relative_shift) {
    keep_factor(attempt.relative_shift, part(progress, 0.0, 0.6));
    watch.lap("factorization");
  }
  map.shift = factor.shift;
  if (!factor.factorization) {
    map.rejection = Rejection::not_factorized;
    return map;
  }

  // z: the eigenvector of the smallest nonzero lambda of L z = lambda B z.
  Eigenvector v = eigenvector(options, attractors, form, factor, attempt, part(progress, 0.6, 1.0));
  map.solves = v.solves;
  map.residual = v.residual;
  map.eigenvalue = v.lambda * eigenvalue_unit(options.method);
  watch.lap("eigenproblem");
  if (!v.converged) {
    map.rejection = Rejection::not_converged;
    return map;
  }

  // Check it.
  const bool finite = v.z.allFinite();
  if (finite) map.turning_number = turning_number(patch_->outer, patch_->triangles, patch_->triangle_weights, v.z);
  MapCheck check;
  check.eigenvalue = v.lambda;
  check.error = v.change;
  check.error_limit = v.change_limit;
  check.area = finite ? signed_area(*energy_, v.z) : 0;
  check.turning_number = map.turning_number;
  check.must_wind_once = options.method == Method::spectral;
  map.rejection = check_map(v.z, check);
  if (map.rejection == Rejection::winding) map.whole = std::move(v.z);
  if (map.rejection != Rejection::none) return map;

  map.z = v.z.head(patch_->n_vertices);
  if (on_boundary) previous_ = v.z;
  map.whole = std::move(v.z);
  watch.lap("eigenproblem");
  return map;
}

SpectralSolver::Eigenvector SpectralSolver::eigenvector(const SolveOptions& options, const Pins& attractors,
                                                        const BoundaryForm& form, ShiftedFactor& factor,
                                                        const Attempt& attempt, const Progress& progress) {
  EigenproblemOptions iteration;
  iteration.tolerance = options.tolerance * attempt.tolerance_factor;
  iteration.start = attempt.start;
  iteration.krylov_dimension = attempt.krylov_dimension;
  Factorization& factorization = *factor.factorization;
  Eigenvector result;
  const auto take = [&result](Eigenpair&& pair) {
    result.z = std::move(pair.vector);
    result.solves = pair.solves;
    result.residual = pair.residual;
    result.change = pair.residual;
    result.converged = pair.converged && pair.residual < eigenproblem_residual_limit;
    return result.converged;
  };
  // Where eigenvalues smaller than the shift lie close together, as on long strips, and the rounding of L is smaller
  // still, as it is not beside the huge entries of thin triangles.
  const bool is_above_rounding = std::numeric_limits<double>::epsilon() * max_diagonal() < attempt.relative_shift;
  const auto tell_apart = [&](const QuotientForm& quotient) {
    if (!is_above_rounding || attempt.exact_steps || (result.converged && result.change < result.change_limit)) return;
    DavidsonResult resolved =
        solve_by_davidson(factorization, *energy_, form, factor.shift, quotient, negligible_change, progress);
    result.solves += resolved.solves;
    if (!(resolved.change < result.change_limit)) return;
    result.z = std::move(resolved.z);
    result.change = resolved.change;
    result.converged = true;
  };

  if (options.has_extenders_or_rigidity() || !attractors.empty()) {
    // B with soft constraints (section 4.2).
    const ExtendedForm extended = extended_form(form, options, attractors);
    ComplexVector circle = ComplexVector::Zero(static_cast<Eigen::Index>(extended.support().size()));
    circle.head(form.mass.size()) =
        start_vector(form, iteration.start).cwiseQuotient(form.mass.cwiseSqrt().cast<Complex>());
    std::vector<ComplexVector> starts{circle};
    const bool kept = &factor == &factor_;
    if (kept && previous_.size() > 0) starts.push_back(extended.restrict(previous_));
    RitzBasis fresh;
    RitzBasis& basis = kept ? ritz_basis_ : fresh;
    result.change_limit = std::max(resolved_change, iteration.tolerance);
    take(solve_extended_eigenproblem(factorization, *energy_, extended, iteration, starts, basis, progress));
    tell_apart(quotient_form(extended));
    if (result.converged) {
      result.lambda = energy_->value(result.z) / extended.value(extended.restrict(result.z));
    }
  } else if (options.method == Method::area) {
    // B = A (section 3.3).
    take(solve_area_eigenproblem(factorization, *energy_, form, factor.shift, iteration, progress));
    if (!result.converged) tell_apart(area_quotient(*energy_));
    if (result.converged) {
      result.lambda = energy_->value(result.z) / energy_->area_form(result.z);
    }
  } else {
    const QuotientForm quotient = quotient_form(form);
    if (take(solve_eigenproblem(factorization, form, iteration, progress))) {
      // The first change is the rounding of the factor; below 1e-10 it is that of the residual.
      CorrectionOptions corrections;
      // Each leaves (lambda + s) / (lambda_2 + s) of the error, lambda_2 being the next eigenvalue.
      corrections.max_corrections = 40;
      corrections.negligible = negligible_change;
      const ComplexVector uncorrected = attempt.exact_steps ? result.z : ComplexVector{};
      Correction correction = correct(factorization, *energy_, quotient, corrections, result.z);
      result.solves += correction.solves;
      if (attempt.exact_steps && !(correction.change < resolved_change)) {
        // Entries near 1e12, next to which the rounding of the factor is as large as lambda: whole corrections then
        // move away from z, by a rate that differs between BLAS kernels, while a measured step always lowers the
        // quotient.
        result.z = uncorrected;
        corrections.max_corrections = 100;  // measured: up to 72
        corrections.negligible = negligible_exact_step;
        corrections.exact_step = true;
        correction = correct(factorization, *energy_, quotient, corrections, result.z);
        result.solves += correction.solves;
      }
      result.change = correction.change;
    }
    tell_apart(quotient);
    if (result.converged) {
      ComplexVector r;
      result.lambda = eigen_residual(*energy_, quotient, result.z, r);  // Eq. 5
      result.residual = r.norm() / (max_diagonal() * result.z.norm());
    }
  }
  return result;
}

ExtendedForm SpectralSolver::extended_form(const BoundaryForm& form, const SolveOptions& options,
                                           const Pins& attractors) const {
  ExtendedForm extended(form);
  const double hole_rigidity = options.hole_rigidity.value_or(0);
  if (hole_rigidity != 0) {
    for (const BoundaryLoop& loop : patch_->inner) {
      const BoundaryForm spread = boundary_form(loop, patch_->positions, boundary_);
      if (!spread.vertices.empty()) extended.add_spread(spread, hole_rigidity);
    }
  }
  for (const Extender& extender : options.extenders) extended.add_extender(extender);
  if (!attractors.empty()) extended.add_attraction(pin_attraction(attractors, form, options.soft_pins));
  return extended;
}

ShiftedFactor SpectralSolver::factored(const BoundaryForm& form, double relative_shift, const Progress& progress,
                                       std::unique_ptr<Factorization> analyzed) {
  HermitianMatrix matrix = energy_->matrix();
  max_diagonal_ = 0;
  for (Eigen::Index v = 0; v < matrix.outerSize(); ++v) {
    max_diagonal_ = std::max(max_diagonal_, matrix.valuePtr()[matrix.outerIndexPtr()[v]].real());
  }
  return factor_shifted(std::move(matrix), patch_->positions, form, relative_shift, backend_, progress,
                        std::move(analyzed));
}

void SpectralSolver::keep_factor(double relative_shift, const Progress& progress) {
  // The structure of L is the same whatever the shift.
  std::unique_ptr<Factorization> analyzed = std::move(factor_.factorization);
  drop_factor();
  factor_ = factored(form_, relative_shift, progress, std::move(analyzed));
  relative_shift_ = relative_shift;
}

double SpectralSolver::max_diagonal() const { return max_diagonal_ > 0 ? max_diagonal_ : energy_->max_diagonal(); }

SpectralMap SpectralSolver::factorize(const Progress& progress) {
  keep_factor(first_relative_shift, progress);
  SpectralMap outcome;
  outcome.attempts = 1;
  outcome.shift = factor_.shift;
  if (!is_factored()) outcome.rejection = Rejection::not_factorized;
  return outcome;
}

bool SpectralSolver::place(ComplexVector& z) const {
  return spectral_conformal::place(z, *energy_, patch_->outer, patch_->surface(),
                                   energy_->area() * patch_->scale * patch_->scale);
}

int SpectralSolver::polish(SpectralMap& map, const Progress& progress, Timings& timings) {
  if (!is_factored()) return 0;
  Stopwatch watch(timings);
  ComplexVector polished = map.whole;
  const int steps = spectral_conformal::polish(*energy_, *factor_.factorization, polished, {}, progress);
  watch.lap("polish");
  if (steps == 0 || !polished.allFinite()) return 0;
  // Looked at where it comes to that: as a rule the border proves that neither covers itself.
  std::optional<int> covering_before;
  const auto covers_more = [&](const ComplexVector& z) {
    const int covering = n_covering_triangles(*patch_, z);
    if (covering > 0 && !covering_before) covering_before = n_covering_triangles(*patch_, map.z);
    return covering > covering_before.value_or(0);
  };
  const auto mean_qc = [this](const ComplexVector& z) {
    return mean_quasi_conformal_distortion(energy_->shapes(), patch_->triangles, patch_->triangle_weights,
                                           patch_->triangles.size() - patch_->n_virtual, z);
  };
  const double mean_qc_before = mean_qc(map.z);
  bool is_sound = false;
  // The polished map may cover itself where the map does not; then not the whole way.
  for (const double fraction : {1.0, 0.5, 0.25}) {
    SpectralMap moved;
    moved.whole = map.whole + fraction * (polished - map.whole);
    const Numbers after = numbers(moved.whole);
    moved.z = moved.whole.head(patch_->n_vertices);
    is_sound = after.turning_number == map.turning_number && signed_area(*energy_, moved.z) > 0 &&
               !covers_more(moved.z) && mean_qc(moved.z) < mean_qc_before;
    if (!is_sound) continue;
    map.z = std::move(moved.z);
    map.whole = std::move(moved.whole);
    map.eigenvalue = after.eigenvalue;
    map.residual = after.residual;
    break;
  }
  watch.lap("polish");
  return is_sound ? steps : 0;
}

SpectralSolver::Numbers SpectralSolver::numbers(const ComplexVector& whole) const {
  Numbers result;
  result.turning_number = turning_number(patch_->outer, patch_->triangles, patch_->triangle_weights, whole);
  ComplexVector r;
  const double lambda = eigen_residual(*energy_, quotient_form(form_), whole, r);
  result.eigenvalue = lambda * eigenvalue_unit(Method::spectral);
  result.residual = r.norm() / (max_diagonal() * whole.norm());
  return result;
}

void SpectralSolver::stretch(const std::vector<TriangleMetric>& metric) {
  energy_->stretch(metric);
  drop_factor();
}

void SpectralSolver::drop_factor() {
  factor_ = {};
  max_diagonal_ = 0;
  forget_maps();
}

void SpectralSolver::forget_maps() {
  ritz_basis_ = {};
  previous_.resize(0);
}

int SpectralSolver::clamp(double min_relative_height) {
  drop_factor();
  return energy_->clamp(min_relative_height);
}

double SpectralSolver::eigenvalue_unit(Method method) const {
  if (method == Method::area) return 1;
  // positions = input / scale. Lengths, and with them M, are divided by scale; L has weight_unit / |T|.
  const bool uniform = energy_->weights() == Weights::uniform;
  const double energy_unit = uniform ? 1 : energy_->weight_unit() * patch_->scale * patch_->scale;
  const bool by_length = method != Method::fiedler && boundary_ == BoundaryMeasure::length;
  return (by_length ? 1 / patch_->scale : 1) / energy_unit;
}

}  // namespace spectral_conformal
