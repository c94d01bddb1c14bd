#include "spectral_conformal/parameterize.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "conformal/eigenproblem.h"
#include "conformal/pin_attraction.h"
#include "conformal/placement.h"
#include "conformal/start_vector.h"
#include "injective/fold_free_map.h"
#include "injective/isometric_relaxation.h"
#include "mesh/boundary_loops.h"
#include "mesh/chart_checks.h"
#include "mesh/hole_filling.h"
#include "parameterization/solve_report.h"
#include "quality/turning_number.h"
#include "spectral_conformal/distortion.h"

namespace spectral_conformal {
namespace {

using Timings = std::vector<std::pair<std::string, double>>;

/// Adds the seconds that pass until the next call to the phase of the given name.
class Stopwatch {
 public:
  explicit Stopwatch(Timings& timings) : timings_(timings), last_(Clock::now()) {}
  void restart() { last_ = Clock::now(); }
  void lap(const char* phase) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    const auto known = std::find_if(timings_.begin(), timings_.end(), [&](const auto& t) { return t.first == phase; });
    if (known != timings_.end()) {
      known->second += seconds;
    } else {
      timings_.emplace_back(phase, seconds);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  Timings& timings_;
  Clock::time_point last_;
};

/// The eigenvector must satisfy its reduced equation at least this well, whatever tolerance was asked for. On flat
/// patches, where lambda vanishes, rounding leaves about 1e-16 / relative_shift, which the corrections then take out.
constexpr double residual_limit = 1e-3;
/// |L z| of a pinned map over its free vertices, relative to its extent and the largest entry of L.
constexpr double pinned_residual_limit = 1e-10;
/// The corrections that follow must end below this change, relative to the map.
constexpr double resolved = 1e-7;
constexpr const char* unresolved =
    "The triangles differ so much in size or shape that double precision does not resolve the map";
constexpr const char* weaken_forces = "weaken or remove extenders, or lower the hole rigidity.";
/// Of the first attempt, which nearly always passes.
constexpr double first_relative_shift = 1e-12;

double largest_diagonal(const HermitianMatrix& matrix) {
  double largest = 0;
  for (int v = 0; v < matrix.cols(); ++v) {
    largest = std::max(largest, matrix.valuePtr()[matrix.outerIndexPtr()[v]].real());
  }
  return largest;
}

/// lambda = z^H L z / z^H B^ z and r = L z - lambda B^ z. Returns lambda.
double eigen_residual(const ConformalEnergy& energy, const BoundaryForm& form, const ComplexVector& z,
                      ComplexVector& r) {
  const double lambda = energy.apply(z, r) / form.value(z);
  form.add_applied(z, -lambda, r);
  return lambda;
}

/// Moves a map so that its only pin is met.
void move_onto_pin(const Pins& pins, ComplexVector& z) {
  const auto& [vertex, position] = *pins.begin();
  z.array() += position - z[vertex];
  z[vertex] = position;
}

/// Whether pins act as a soft force.
bool is_attracted(const SolveOptions& options) { return options.method == Method::spectral && options.soft_pins > 0; }

}  // namespace

/// What each attempt at the eigenproblem changes; the first one nearly always passes.
struct Solver::Attempt {
  double relative_shift;  ///< s as a part of the median of L_ii / M_ii over the vertices with mass
  unsigned start;
  int krylov_dimension;
  double tolerance_factor;
  const char* remedy;  ///< said when this attempt passes
};

Solver::Solver(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& options,
               const std::vector<TriangleMetric>& metric)
    : n_vertices_(chart.n_vertices()), options_(options) {
  Stopwatch watch(set_up_timings_);
  const std::string problem = why_not_parameterizable(chart, positions);
  if (!problem.empty()) throw InvalidMesh(problem);
  // Centred and scaled to extent 1, any coordinates give the same numbers.
  const Eigen::RowVector3d low = positions.colwise().minCoeff();
  const Eigen::RowVector3d high = positions.colwise().maxCoeff();
  scale_ = (high - low).maxCoeff();
  positions_ = (positions.rowwise() - (low + 0.5 * (high - low))) / scale_;
  const int outer = outer_loop(chart.boundary_loops, positions_);
  for (std::size_t i = 0; i < chart.boundary_loops.size(); ++i) {
    if (static_cast<int>(i) == outer) {
      outer_ = chart.boundary_loops[i];
    } else {
      inner_.push_back(chart.boundary_loops[i]);
    }
  }
  std::vector<std::array<int, 3>> triangles = chart.triangles;
  std::vector<double> triangle_weights = chart.triangle_weights;
  if (options.fill_holes && !inner_.empty()) {
    const HoleFilling filling = spectral_conformal::fill_holes(chart.boundary_loops, outer, positions_);
    triangles.insert(triangles.end(), filling.triangles.begin(), filling.triangles.end());
    triangle_weights.insert(triangle_weights.end(), filling.triangle_weights.begin(), filling.triangle_weights.end());
    positions_.conservativeResize(n_vertices_ + filling.centres.rows(), 3);
    positions_.bottomRows(filling.centres.rows()) = filling.centres;
  }
  const std::size_t n_virtual = triangles.size() - chart.triangles.size();
  energy_ = std::make_unique<ConformalEnergy>(positions_, std::move(triangles), std::move(triangle_weights),
                                              options.weights, n_virtual);
  for (std::size_t t = 0; t < metric.size(); ++t) {
    if (!is_positive_definite(metric[t]) && !energy_->shapes()[t].clamped) {
      throw InvalidMesh("The metric of face " + std::to_string(chart.faces[chart.triangle_face[t]]) +
                        " is not positive definite in double precision; both of its eigenvalues must be positive.");
    }
  }
  if (!metric.empty()) energy_->stretch(metric);
  form_ = boundary_form(outer_, positions_, options.boundary);
  if (form_.vertices.size() < 2) {
    throw InvalidMesh("The patch's longest boundary loop has no length; clean up its coincident vertices.");
  }
  repairs_ = describe_repairs(chart, energy_->clamped_triangles());
  watch.lap("assembly");
}

Solver::ShiftedFactor Solver::factor_shifted(const BoundaryForm& form, double relative_shift,
                                             const Progress& progress) {
  ShiftedFactor result;
  HermitianMatrix shifted;  // Eigen 3.4's copy constructor leaks where memory runs out
  shifted = energy_->matrix();
  // The median withstands the huge entries of tiny triangles, next to which a shift would drown the small eigenvalues.
  std::vector<double> ratios;
  ratios.reserve(form.vertices.size());
  for (std::size_t i = 0; i < form.vertices.size(); ++i) {
    ratios.push_back(shifted.valuePtr()[shifted.outerIndexPtr()[form.vertices[i]]].real() / form.mass[i]);
  }
  const auto median = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), median, ratios.end());
  const double unit = *median;
  result.factorization = make_factorization(options_.backend, shifted.rows());
  report(progress, 0.0, "ordering");
  result.factorization->analyze(shifted);
  constexpr int max_raises = 4;
  for (int raise = 0; raise <= max_raises; ++raise) {
    report(progress, 0.2, "factorization");
    result.shift = relative_shift * std::pow(100.0, raise) * unit;
    for (std::size_t i = 0; i < form.vertices.size(); ++i) {
      const int v = form.vertices[i];
      shifted.valuePtr()[shifted.outerIndexPtr()[v]] =
          energy_->matrix().valuePtr()[energy_->matrix().outerIndexPtr()[v]] + result.shift * form.mass[i];
    }
    if (result.factorization->factorize(shifted)) return result;
  }
  throw SolveFailure("The conformal energy could not be factorised, even with a shift of " +
                         std::to_string(result.shift) + " of the boundary form",
                     "the patch has too many degenerate triangles; merge vertices by distance or dissolve degenerate "
                     "faces.");
}

void Solver::factorize(const Progress& progress) {
  if (factor_.factorization) return;
  blend_area(part(progress, 0.0, options_.area_blend > 0 ? 0.8 : 0.0));
  Stopwatch watch(set_up_timings_);
  factor_ = factor_shifted(form_, first_relative_shift, part(progress, options_.area_blend > 0 ? 0.8 : 0.0, 1.0));
  watch.lap("factorization");
}

bool SolveOptions::has_forces() const {
  return hole_rigidity != 0 ||
         std::any_of(extenders.begin(), extenders.end(), [](const Extender& e) { return e.strength != 0; });
}

Method method_with_pins(const SolveOptions& options, std::size_t n_pins) {
  if (n_pins < 2 || options.method == Method::lscm || is_attracted(options)) return options.method;
  if (options.method == Method::spectral) return Method::lscm;
  throw InvalidMesh(
      "The methods 'fiedler' and 'area' hold no pins; use 'spectral' or 'lscm', or remove all pins but one.");
}

Parameterization Solver::solve(const SolveOptions& given, const Pins& pins, const Progress& progress) {
  SolveOptions options = given;
  options.method = method_with_pins(given, pins.size());
  if (options.method != Method::spectral && options.has_forces()) {
    throw InvalidMesh("Extenders and hole rigidity need the method 'spectral', and pins that are soft, if any.");
  }
  int attempts = 0;
  Parameterization result = options_.fold_free ? solve_fold_free(options, pins, progress)
                                               : solve_with_folds(options, pins, progress, attempts);
  if (options.method != Method::lscm && !pins.empty() && !fit_to_pins(result.z, pins)) {
    throw InvalidMesh("All pins have the same position, so the map would shrink to a point; move one of them.");
  }
  if (options.method == Method::lscm || result.unfolded > 0 || result.is_embedding) {
    result.eigenvalue_of = EigenvalueOf::map;
  }
  result.message += describe_unresolved(*energy_, result.z) + repairs_;
  if (!result.message.empty()) result.message.pop_back();  // the space after the last sentence
  report(progress, 1.0, "done");
  return result;
}

Parameterization Solver::solve_with_folds(const SolveOptions& options, const Pins& pins, const Progress& progress,
                                          int& attempts) {
  if (options.method != Method::lscm) {
    return solve_with_remedies(options, is_attracted(options) ? pins : Pins{}, progress, attempts);
  }
  blend_area(part(progress, 0.0, 0.5));
  return solve_pinned(pins, progress);
}

Parameterization Solver::solve_fold_free(const SolveOptions& options, const Pins& pins, const Progress& progress) {
  Parameterization result;
  std::string failure;
  int attempts = 0;
  // A single pin only moves the map, which may cost it digits: at the end.
  const bool moved = options.method == Method::lscm && pins.size() == 1;
  try {
    result = solve_with_folds(options, moved ? Pins{} : pins, part(progress, 0.0, 0.5), attempts);
  } catch (const SolveFailure& problem) {
    // Hard pins have no other map; everything else has the embedding.
    if (options.method == Method::lscm && pins.size() > 1) throw;
    failure = problem.reason();
    result.method = options.method;
    result.attempts = attempts;
    result.timings = set_up_timings_;
  }
  unfold(options, pins, failure, part(progress, 0.5, 1.0), result);
  if (moved) move_onto_pin(pins, result.z);
  return result;
}

double Solver::mean_distortion(const ComplexVector& z) const {
  const auto n = static_cast<std::ptrdiff_t>(energy_->triangles().size() - energy_->n_virtual());
  const auto triangles = energy_->triangles().begin();
  const auto triangle_weights = energy_->triangle_weights().begin();
  return measure_distortion(positions_.topRows(n_vertices_), {triangles, triangles + n},
                            {triangle_weights, triangle_weights + n}, z)
      .mean_qc;
}

ComplexVector Solver::with_virtual_vertices(const ComplexVector& z) const {
  ComplexVector all = ComplexVector::Zero(energy_->n_vertices());
  all.head(n_vertices_) = z;
  Eigen::VectorXd neighbours = Eigen::VectorXd::Zero(all.size());
  for (std::size_t t = energy_->triangles().size() - energy_->n_virtual(); t < energy_->triangles().size(); ++t) {
    const auto& triangle = energy_->triangles()[t];
    for (int k = 0; k < 3; ++k) {
      const int middle = triangle[k];
      const int corner = triangle[(k + 1) % 3];
      if (middle < n_vertices_ || corner >= n_vertices_) continue;
      all[middle] += z[corner];
      neighbours[middle] += 1;
    }
  }
  for (Eigen::Index v = n_vertices_; v < all.size(); ++v) all[v] /= std::max(neighbours[v], 1.0);
  return all;
}

void Solver::unfold(const SolveOptions& options, const Pins& pins, const std::string& failure, const Progress& progress,
                    Parameterization& result) {
  Stopwatch watch(result.timings);
  const bool held = options.method == Method::lscm && pins.size() > 1;
  std::vector<char> held_vertices(held ? static_cast<std::size_t>(n_vertices_) : 0, 0);
  if (held) {
    for (const auto& pin : pins) held_vertices[pin.first] = 1;
  }
  std::vector<BoundaryLoop> loops{outer_};
  loops.insert(loops.end(), inner_.begin(), inner_.end());
  const double before = result.z.size() > 0 ? mean_distortion(result.z) : std::numeric_limits<double>::quiet_NaN();
  // Pins may hold the map mirrored, which is no fold.
  const bool mirrored = held && signed_area(*energy_, result.z) < 0;
  FoldFreeMap map = fold_free_map({*energy_, positions_.topRows(n_vertices_), loops, held_vertices, options_.backend},
                                  mirrored ? ComplexVector(result.z.conjugate()) : result.z, progress);
  if (mirrored) map.z = map.z.conjugate().eval();
  watch.lap("unfolding");
  if (map.folded == map.folded_before && !map.is_embedding) {
    result.message += describe_unfolding(map, failure, before, before, result.turning_number, held);
    return;
  }
  if (map.is_embedding) result.fallback = Fallback::tutte_embedding;
  // Those of the quotient below.
  result.weights = energy_->weights();
  result.boundary = options_.boundary;
  result.clamped_triangles = 0;
  result.unfolded = map.is_embedding ? map.folded_before : map.folded_before - map.folded;
  result.is_embedding = map.is_embedding;
  result.mean_qc_before = before;
  result.z = std::move(map.z);
  if (!held && !place(result.z, *energy_, outer_, positions_.topRows(n_vertices_), energy_->area() * scale_ * scale_)) {
    throw SolveFailure("The map has no positive area", "add seams that make the patch flatter.");
  }
  const ComplexVector z = with_virtual_vertices(result.z);
  result.turning_number = turning_number(outer_, energy_->triangles(), energy_->triangle_weights(), z);
  ComplexVector r;
  const double lambda = eigen_residual(*energy_, form_, z, r);
  result.eigenvalue = lambda * lambda_unit(Method::spectral);
  result.residual = r.norm() / (largest_diagonal(energy_->matrix()) * result.z.norm());
  result.message += describe_unfolding(map, failure, before, mean_distortion(result.z), result.turning_number, held);
}

Parameterization Solver::solve_with_remedies(const SolveOptions& options, const Pins& attractors,
                                             const Progress& progress, int& attempts) {
  try {
    return solve_eigenvector(options, attractors, progress, attempts);
  } catch (const SolveFailure& failure) {
    // With forces, the forces are what to change.
    if (options.method != Method::spectral || options.has_forces() || !options.fallbacks) throw;
    const bool by_length = options_.boundary == BoundaryMeasure::length;
    const bool uniform = energy_->weights() == Weights::uniform;
    struct Remedy {
      Weights weights;
      BoundaryMeasure boundary;
      double least_height;
      Fallback fallback;
      const char* name;
    };
    const Remedy remedies[] = {
        {energy_->weights(), options_.boundary, 1e-5, Fallback::clamped_triangles,
         "triangles thinner than 1e-5 of their length raised to that"},
        {energy_->weights(), by_length ? BoundaryMeasure::vertex : BoundaryMeasure::length, 0, Fallback::other_boundary,
         by_length ? "the boundary form 'vertex'" : "the boundary form 'length'"},
        {uniform ? Weights::inverse_area : Weights::uniform, options_.boundary, 0, Fallback::other_weights,
         uniform ? "the weights 'inverse_area'" : "the weights 'uniform'"}};
    for (const Remedy& remedy : remedies) {
      try {
        Solver other(*this, remedy.weights, remedy.boundary);
        const int clamped = remedy.least_height > 0 ? other.energy_->lift(remedy.least_height) : 0;
        if (remedy.least_height > 0 && clamped == 0) continue;
        // The fraction done only rises: the failed attempt has used it up.
        const Progress rest = [&progress](double, const char* phase) { return !progress || progress(0.95, phase); };
        Parameterization result = other.solve_eigenvector(options, attractors, rest, attempts);
        result.fallback = remedy.fallback;
        result.clamped_triangles = clamped;
        result.message = failure.reason() + ": solved with " + remedy.name + " instead. " + result.message;
        return result;
      } catch (const SolveFailure&) {
        continue;  // the first failure is the one to tell
      }
    }
    throw;
  }
}

Solver::Solver(const Solver& like, Weights weights, BoundaryMeasure boundary)
    : positions_(like.positions_),
      n_vertices_(like.n_vertices_),
      scale_(like.scale_),
      energy_(std::make_unique<ConformalEnergy>(*like.energy_, weights)),
      outer_(like.outer_),
      inner_(like.inner_),
      options_(like.options_),
      form_(boundary_form(outer_, positions_, boundary)),
      is_blended_(like.is_blended_) {
  options_.weights = weights;
  options_.boundary = boundary;
}

double Solver::lambda_unit(Method method) const {
  if (method == Method::area) return 1;
  // positions_ = positions / scale_. Lengths, and with them M, are divided by scale_; L has weight_unit / |T|.
  const bool uniform = energy_->weights() == Weights::uniform;
  const double energy_unit = uniform ? 1 : energy_->weight_unit() * scale_ * scale_;
  const double mass_unit = method != Method::fiedler && options_.boundary == BoundaryMeasure::length ? 1 / scale_ : 1;
  return mass_unit / energy_unit;
}

ExtendedForm Solver::extended_form(const BoundaryForm& form, const SolveOptions& options,
                                   const Pins& attractors) const {
  ExtendedForm extended(form);
  if (options.hole_rigidity != 0) {
    for (const BoundaryLoop& loop : inner_) {
      const BoundaryForm spread = boundary_form(loop, positions_, options_.boundary);
      if (!spread.vertices.empty()) extended.add_spread(spread, options.hole_rigidity);
    }
  }
  for (const Extender& extender : options.extenders) extended.add_extender(extender);
  if (!attractors.empty()) extended.add_attraction(pin_attraction(attractors, form, options.soft_pins));
  return extended;
}

void Solver::correct(const BoundaryForm& form, Factorization& factorization, Eigenvector& eigenvector) const {
  // Inverse iteration on the residual, which is evaluated more accurately than the factor: takes out what rounding in
  // the factor left. The first change tells how much that was.
  ComplexVector r;
  ComplexVector change;
  constexpr int max_corrections = 40;
  constexpr double negligible = 1e-10;
  double relative_change = 0;
  for (int k = 0; k < max_corrections; ++k) {
    eigen_residual(*energy_, form, eigenvector.z, r);
    factorization.solve(r, change);
    change.array() -= change.mean();
    ++eigenvector.solves;
    eigenvector.z -= change;
    relative_change = change.norm() / eigenvector.z.norm();
    if (!(relative_change > negligible)) break;
  }
  eigenvector.lambda = eigen_residual(*energy_, form, eigenvector.z, r);
  eigenvector.residual = r.norm() / (largest_diagonal(energy_->matrix()) * eigenvector.z.norm());
  if (!(relative_change < resolved)) eigenvector.why_not = unresolved;
}

Solver::Eigenvector Solver::attempt(const SolveOptions& settings, const Pins& attractors, const BoundaryForm& form,
                                    ShiftedFactor& factor, const Attempt& attempt, const Progress& progress) {
  EigenproblemOptions options;
  options.tolerance = settings.tolerance * attempt.tolerance_factor;
  options.start = attempt.start;
  options.krylov_dimension = attempt.krylov_dimension;
  Eigenvector result;
  const auto take = [&](Eigenpair&& pair) {
    result.z = std::move(pair.vector);
    result.solves = pair.solves;
    result.residual = pair.residual;
    if (!pair.converged || !(pair.residual < residual_limit))
      result.why_not = "The eigenvalue iteration did not converge";
    return result.why_not == nullptr;
  };
  Factorization& factorization = *factor.factorization;
  if (settings.has_forces() || !attractors.empty()) {
    const ExtendedForm extended = extended_form(form, settings, attractors);
    const bool kept = &factor == &factor_;
    ComplexVector circle = ComplexVector::Zero(static_cast<Eigen::Index>(extended.support().size()));
    circle.head(form.mass.size()) =
        start_vector(form, options.start).cwiseQuotient(form.mass.cwiseSqrt().cast<Complex>());
    std::vector<ComplexVector> starts{circle};
    if (kept && previous_.size() > 0) starts.push_back(extended.restrict(previous_));
    RitzBasis fresh;
    RitzBasis& basis = kept ? ritz_basis_ : fresh;
    if (take(solve_extended_eigenproblem(factorization, *energy_, extended, options, starts, basis, progress))) {
      result.lambda = energy_->value(result.z) / extended.value(extended.restrict(result.z));
      if (!(result.residual < std::max(resolved, options.tolerance))) result.why_not = unresolved;
    }
  } else if (settings.method == Method::area) {
    if (take(solve_area_eigenproblem(factorization, *energy_, form, factor.shift, options, progress))) {
      result.lambda = energy_->value(result.z) / energy_->area_form(result.z);
    }
  } else if (take(solve_eigenproblem(factorization, form, options, progress))) {
    correct(form, factorization, result);
  }
  return result;
}

Parameterization Solver::solve_eigenvector(const SolveOptions& settings, const Pins& given, const Progress& progress,
                                           int& attempts_made, ComplexVector* with_virtual) {
  constexpr Attempt attempts[] = {
      {first_relative_shift, 0, 6, 1.0, ""},
      {1e-10, 1, 24, 0.1, "The first solve failed its checks and was repeated with a larger shift and another start. "},
  };
  const Method method = settings.method;
  // With fewer than three pins a similarity always fits.
  const Pins attractors = given.size() > 2 ? given : Pins{};
  const bool own_form = method == Method::fiedler;
  if (own_form) blend_area(part(progress, 0.0, 0.3));
  const BoundaryForm identity = own_form ? identity_form(n_vertices_) : BoundaryForm{};
  const BoundaryForm& form = own_form ? identity : form_;
  Timings timings;
  std::string why;
  for (const Attempt& attempt : attempts) {
    ++attempts_made;
    Stopwatch watch(timings);
    ShiftedFactor own_factor;
    const bool first = &attempt == &attempts[0];
    if (first && !own_form) {
      const bool factored = factor_.factorization != nullptr;
      factorize(part(progress, 0.0, 0.6));
      if (factored) report(progress, 0.6, "eigenproblem");
      watch.restart();  // factorize() has its own time
    } else {
      own_factor = factor_shifted(form, attempt.relative_shift, part(progress, 0.0, 0.6));
      watch.lap("factorization");
    }
    ShiftedFactor& factor = own_factor.factorization ? own_factor : factor_;
    Eigenvector eigenvector = this->attempt(settings, attractors, form, factor, attempt, part(progress, 0.6, 0.95));
    if (eigenvector.why_not != nullptr) {
      why = eigenvector.why_not;
      continue;
    }
    Parameterization result;
    result.method = method;
    result.weights = energy_->weights();
    result.boundary = options_.boundary;
    result.attempts = attempts_made;
    result.iterations = eigenvector.solves;
    result.residual = eigenvector.residual;
    result.eigenvalue = eigenvector.lambda * lambda_unit(method);
    watch.lap("eigenproblem");
    result.turning_number = turning_number(outer_, energy_->triangles(), energy_->triangle_weights(), eigenvector.z);
    if (!eigenvector.z.allFinite() || !std::isfinite(eigenvector.lambda)) {
      why = "The result is not finite";
      continue;
    }
    result.z = eigenvector.z.head(n_vertices_);
    if (!place(result.z, *energy_, outer_, positions_.topRows(n_vertices_), energy_->area() * scale_ * scale_)) {
      why = "The map has no positive area";
      continue;
    }
    const bool winds_once = std::abs(result.turning_number) == 1;
    if (method == Method::spectral && !winds_once) {
      why = describe_winding(result.turning_number);
      // A strong attraction has such maps as its true optimum, so that another attempt would end there too: the pair
      // meets where the map branches.
      if (settings.has_forces()) throw SolveFailure(why, weaken_forces);
      continue;
    }
    if (with_virtual != nullptr) *with_virtual = eigenvector.z;
    if (&factor == &factor_) previous_ = std::move(eigenvector.z);
    watch.lap("placement");
    result.message = attempt.remedy;
    if (!winds_once) {
      result.message += describe_winding(result.turning_number) + ". ";
    }
    result.timings = set_up_timings_;
    result.timings.insert(result.timings.end(), timings.begin(), timings.end());
    return result;
  }
  throw SolveFailure(
      why + ", in " + std::to_string(std::size(attempts)) + " attempts with different shifts and starts",
      settings.has_forces() ? weaken_forces : "add seams that make the patch flatter, or clean up degenerate faces.");
}

void Solver::blend_area(const Progress& progress) {
  if (is_blended_ || !(options_.area_blend > 0)) return;
  Stopwatch watch(set_up_timings_);
  Solver conformal(*this, energy_->weights(), options_.boundary);
  conformal.is_blended_ = true;
  ComplexVector z;
  int attempts = 0;
  conformal.solve_eigenvector({}, {}, part(progress, 0.0, 0.2), attempts, &z);
  const IsometricMap relaxed =
      relax_to_isometry(energy_->triangles(), energy_->energy_shapes(), energy_->triangle_weights(),
                        energy_->n_virtual(), std::move(z), options_.backend, {}, part(progress, 0.2, 1.0));
  std::string repairs = repairs_ + describe_relaxation(relaxed);
  std::vector<TriangleMetric> metric;
  metric.reserve(energy_->triangles().size());
  for (std::size_t t = 0; t < energy_->triangles().size(); ++t) {
    const auto& [a, b, c] = energy_->triangles()[t];
    metric.push_back(
        blend(metric_of_map(energy_->energy_shapes()[t], relaxed.z[b] - relaxed.z[a], relaxed.z[c] - relaxed.z[a]),
              options_.area_blend));
  }
  // All or nothing: where memory runs out, the next solve begins with what is here now.
  auto stretched = std::make_unique<ConformalEnergy>(*energy_, energy_->weights());
  stretched->stretch(metric);
  watch.lap("area blend");
  energy_ = std::move(stretched);
  repairs_ = std::move(repairs);
  is_blended_ = true;
}

Parameterization Solver::solve_pinned(const Pins& pins, const Progress& progress) {
  Parameterization result;
  result.method = Method::lscm;
  result.weights = energy_->weights();
  result.boundary = options_.boundary;
  result.timings = set_up_timings_;
  Stopwatch watch(result.timings);
  const bool hold = pins.size() >= 2;
  Pins held;
  Complex origin = 0;
  double unit = 1;
  if (hold) {
    // Lengths of the plane are measured in a unit of their own, so that pins of any magnitude solve alike.
    for (const auto& pin : pins) origin += pin.second / static_cast<double>(pins.size());
    double extent = 0;
    for (const auto& pin : pins) {
      const Complex offset = pin.second - origin;
      extent = std::max({extent, std::abs(offset.real()), std::abs(offset.imag())});
    }
    // Rounding alone can make an extent of the smallest numbers.
    const bool equal =
        std::all_of(pins.begin(), pins.end(), [&pins](const auto& pin) { return pin.second == pins.begin()->second; });
    if (equal || !(extent > 0) || !std::isfinite(extent)) {
      throw InvalidMesh("All pins have the same position, so the map would shrink to a point; move one of them.");
    }
    for (const auto& [vertex, position] : pins) held[vertex] = (position - origin) / extent;
    unit = extent;
  } else {
    const auto pair = farthest_boundary_vertices(outer_, positions_, energy_->matrix());
    held[pair[0]] = 0.0;
    held[pair[1]] = (positions_.row(pair[1]) - positions_.row(pair[0])).norm() > 0
                        ? (positions_.row(pair[1]) - positions_.row(pair[0])).norm()
                        : 1.0;
  }
  PinnedSolution solution = solve_lscm(*energy_, held, options_.backend, progress);
  result.z = std::move(solution.vector);
  result.residual = solution.residual;
  result.iterations = 1;
  watch.lap("solve");
  if (!result.z.allFinite()) throw SolveFailure("The pinned map is not finite", "clean up degenerate faces.");
  result.turning_number = turning_number(outer_, energy_->triangles(), energy_->triangle_weights(), result.z);
  result.eigenvalue = energy_->value(result.z) / form_.value(result.z) * lambda_unit(Method::lscm);
  // With pins on vertices without mass the rest may all lie in one point.
  if (!std::isfinite(result.eigenvalue)) {
    throw SolveFailure("The pinned map shrinks the boundary to a point",
                       "pin other vertices, or merge vertices by distance.");
  }
  if (!(result.residual < pinned_residual_limit)) {
    throw SolveFailure("The pinned map does not satisfy its equations in double precision",
                       "clean up degenerate faces, or pin other vertices.");
  }
  if (std::abs(result.turning_number) != 1) {
    result.message = describe_winding(result.turning_number) + ". ";
  }
  result.z.conservativeResize(n_vertices_);
  if (hold) {
    for (Complex& z : result.z) z = origin + unit * z;
    for (const auto& [vertex, position] : pins) result.z[vertex] = position;
  } else {
    if (!place(result.z, *energy_, outer_, positions_.topRows(n_vertices_), energy_->area() * scale_ * scale_)) {
      throw SolveFailure("The pinned map has no positive area", "use the spectral method, or pin other vertices.");
    }
    if (pins.size() == 1) move_onto_pin(pins, result.z);
  }
  watch.lap("placement");
  return result;
}

}  // namespace spectral_conformal
