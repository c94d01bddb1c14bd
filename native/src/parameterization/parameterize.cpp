#include "spectral_conformal/parameterize.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "concurrency/listening.h"
#include "conformal/correction.h"
#include "conformal/pin_attraction.h"
#include "mesh/chart_checks.h"
#include "mesh/charts.h"
#include "parameterization/area_blend.h"
#include "parameterization/chart_metric.h"
#include "parameterization/fallbacks.h"
#include "parameterization/hole_rigidity.h"
#include "parameterization/pinned_map.h"
#include "parameterization/report.h"
#include "parameterization/spectral_solver.h"
#include "parameterization/unfolding.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

bool is_attracted(const SolveOptions& options) { return options.method == Method::spectral && options.soft_pins > 0; }

void take(SpectralMap&& map, Parameterization& result) {
  result.z = std::move(map.z);
  result.eigenvalue = map.eigenvalue;
  result.residual = map.residual;
  result.iterations = map.solves;
  result.turning_number = map.turning_number;
}

}  // namespace

bool SolveOptions::has_extenders() const {
  return std::any_of(extenders.begin(), extenders.end(), [](const Extender& e) { return e.strength != 0; });
}

bool SolveOptions::has_extenders_or_rigidity() const { return hole_rigidity.value_or(0) != 0 || has_extenders(); }

Method method_with_pins(const SolveOptions& options, std::size_t n_pins) {
  if (n_pins < 2 || options.method == Method::lscm || is_attracted(options)) return options.method;
  if (options.method == Method::spectral) return Method::lscm;
  throw InvalidMesh(
      "The methods 'fiedler' and 'area' hold no pins; use 'spectral' or 'lscm', or remove all pins but one.");
}

struct Solver::State {
  PatchOptions options;
  Timings timings;  ///< of what is done once
  NormalizedPatch patch;
  SpectralSolver spectral;
  bool has_metric = false;
  std::string repairs;  ///< sentences, each with a space behind
  bool is_blended = false;
  std::optional<RelaxationStatus> relaxation;
  double scale_deviation_before = std::numeric_limits<double>::quiet_NaN();
  // Of a solver made from a mesh; empty otherwise.
  std::vector<int> vertices;  ///< the mesh vertex of each chart vertex, ascending
  int n_mesh_vertices = 0;

  State(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& patch_options)
      : options(patch_options),
        patch(normalized_patch(chart, positions, patch_options.fill_holes)),
        spectral(patch, patch_options.weights, patch_options.boundary, patch_options.backend),
        repairs(describe_repairs(chart, spectral.energy().clamped_triangles())) {}

  int chart_vertex(int mesh_vertex, const char* role) const;
  void blend(const Progress& progress);
  SpectralMap factorize(const Progress& progress);
  std::optional<SolveFailure> solve_pinned(const SolveOptions& settings, const Pins& pins, const Progress& progress,
                                           Parameterization& result);
  SpectralMap solve_eigenproblem(const SolveOptions& settings, const Pins& attractors, const Progress& progress,
                                 Parameterization& result);
  std::optional<SolveFailure> solve_spectral(const SolveOptions& given, const Pins& attractors,
                                             const Progress& progress, Parameterization& result);
  void unfold(const Pins& held, const std::optional<SolveFailure>& failure, const Progress& progress,
              Parameterization& result);
  void take_unfolded(UnfoldedMap&& unfolded, const std::string& failure, bool held, Parameterization& result) const;
  Parameterization solve(const SolveOptions& settings, const Pins& pins, const Progress& progress);
};

int Solver::State::chart_vertex(int mesh_vertex, const char* role) const {
  const auto found = std::lower_bound(vertices.begin(), vertices.end(), mesh_vertex);
  if (found == vertices.end() || *found != mesh_vertex) {
    throw InvalidMesh("Vertex " + std::to_string(mesh_vertex) + " " + role + ", but no triangle uses it.");
  }
  return static_cast<int>(found - vertices.begin());
}

void Solver::State::blend(const Progress& progress) {
  if (is_blended || !(options.area_blend > 0)) return;
  Timings spent = timings;
  Stopwatch watch(spent);
  const AreaBlend blended = blend_area(spectral, options.area_blend, progress);
  std::string sentences = repairs + describe_relaxation(blended.relaxed);
  // All or nothing: where memory runs out, the next solve begins with what was there.
  watch.lap("area blend");
  spectral.stretch(blended.metric);
  timings.swap(spent);
  repairs.swap(sentences);
  relaxation = blended.relaxed.status;
  scale_deviation_before = blended.scale_deviation_before;
  is_blended = true;
}

// The fractions of progress in this file and in area_blend.cpp are guesses of the time that phases take: a blend is
// many factorisations, a factorisation somewhat longer than the eigenproblem. They only have to rise.

/// The outcome has no map.
SpectralMap Solver::State::factorize(const Progress& progress) {
  if (spectral.is_factored()) return {};
  const double blended = options.area_blend > 0 ? 0.8 : 0.0;
  blend(part(progress, 0.0, blended));
  Stopwatch watch(timings);
  SpectralMap outcome = spectral.factorize(part(progress, blended, 1.0));
  watch.lap("factorization");
  return outcome;
}

/// Pins are held exactly; a single one is left to the caller.
std::optional<SolveFailure> Solver::State::solve_pinned(const SolveOptions& settings, const Pins& pins,
                                                        const Progress& progress, Parameterization& result) {
  try {
    blend(part(progress, 0.0, 0.5));
  } catch (const SolveFailure& failure) {
    return failure;
  }
  result.timings = timings;
  SpectralMap map = spectral_conformal::solve_pinned(
      spectral, pins, part(progress, options.area_blend > 0 ? 0.5 : 0.0, 1.0), result.timings);
  result.attempts = map.attempts;
  result.eigenvalue_of = EigenvalueOf::map;
  if (map.rejection != Rejection::none) return failure_of(map, settings);
  result.message = describe_attempts(map, settings);
  take(std::move(map), result);
  return std::nullopt;
}

/// The placed map of a factored patch, polished where that was asked for, and what it is the map of.
SpectralMap Solver::State::solve_eigenproblem(const SolveOptions& settings, const Pins& attractors,
                                              const Progress& progress, Parameterization& result) {
  const bool is_free = settings.method == Method::spectral && !settings.has_extenders() && attractors.empty();
  // Where less is asked for than single precision stores, as while a slider moves, a start near the end saves solves.
  if (!(settings.tolerance > resolved_change)) spectral.forget_maps();
  SpectralMap map;
  std::optional<SpectralMap> with_free_holes;
  if (is_free && settings.hole_rigidity != 0.0) {
    RigidMap rigid = solve_with_rigid_holes(spectral, settings, progress, result.timings);
    result.hole_rigidity = rigid.rigidity;
    result.message = describe_rigidity(settings.hole_rigidity, rigid.rigidity);
    map = std::move(rigid.map);
    with_free_holes = std::move(rigid.free);
    result.attempts = rigid.attempts;
  } else {
    map = spectral.solve(settings, attractors, progress, result.timings);
    result.hole_rigidity = settings.hole_rigidity.value_or(0);
    result.attempts = map.attempts;
  }
  if (map.rejection != Rejection::none) return map;
  result.message += describe_attempts(map, settings);
  // What was asked of the shape is not to be polished away.
  const bool is_shaped = is_blended || has_metric || settings.hole_rigidity.value_or(0) != 0;
  if (options.polish && is_free && !is_shaped) {
    result.polish_steps = spectral.polish(map, progress, result.timings);
    if (with_free_holes) {
      // The lead of rigid holes can be less than what polishing takes away.
      const int steps = spectral.polish(*with_free_holes, progress, result.timings);
      const Distortion rigid = chart_distortion(patch, map.z);
      const Distortion free = chart_distortion(patch, with_free_holes->z);
      const bool covers_more = may_cover_itself(patch, with_free_holes->z) && !may_cover_itself(patch, map.z);
      if (free.mean_qc < rigid.mean_qc && free.n_flipped() <= rigid.n_flipped() && !covers_more) {
        map = std::move(*with_free_holes);
        result.hole_rigidity = 0;
        result.polish_steps = steps;
      }
    }
    if (result.polish_steps > 0) result.eigenvalue_of = EigenvalueOf::map;
  }
  Stopwatch watch(result.timings);
  spectral.place(map.z);
  watch.lap("placement");
  return map;
}

std::optional<SolveFailure> Solver::State::solve_spectral(const SolveOptions& given, const Pins& attractors,
                                                          const Progress& progress, Parameterization& result) {
  SolveOptions settings = given;
  // A metric is what the map is to be measured by, not the distortion that rigidity is chosen by.
  const bool is_chosen = attractors.empty() && !settings.has_extenders() && !has_metric && !(options.area_blend > 0);
  if (patch.inner.empty() || (!settings.hole_rigidity && !is_chosen)) settings.hole_rigidity = 0;
  const bool own_factor = settings.method == Method::fiedler;
  const double begun = own_factor ? 0.3 : 0.6;
  SpectralMap map;
  std::optional<SolveFailure> failed_blend;
  try {
    if (own_factor) {
      blend(part(progress, 0.0, begun));
    } else {
      map = factorize(part(progress, 0.0, begun));
    }
  } catch (const SolveFailure& failure) {
    failed_blend = failure;
  }
  result.timings = timings;
  result.attempts = 1;
  if (!failed_blend && map.rejection == Rejection::none) {
    map = solve_eigenproblem(settings, attractors, part(progress, begun, 0.95), result);
    if (map.rejection == Rejection::none) {
      take(std::move(map), result);
      return std::nullopt;
    }
  }
  // Rigidity that was not lowered to 0 acts together with forces.
  settings.hole_rigidity = result.hole_rigidity;
  SolveFailure failure = failed_blend ? *failed_blend : failure_of(map, settings);
  // With soft constraints, these are what to change.
  if (settings.method != Method::spectral || settings.has_extenders_or_rigidity() || !settings.fallbacks)
    return failure;
  // The fraction done only rises: the failed attempts have used it up.
  const Progress rest = [&progress](double, const char* phase) { return !progress || progress(0.95, phase); };
  const double not_blended = is_blended ? 0 : options.area_blend;
  // Other problems have factors of their own, which are as large.
  spectral.drop_factor();
  std::optional<FallbackMap> other =
      solve_fallback(spectral, map, settings, attractors, not_blended, rest, result.timings, result.attempts);
  if (!other) return failure;
  if (other->unfolded) {
    take_unfolded(std::move(*other->unfolded), failure.reason(), false, result);
    result.fallback = other->fallback;
    return std::nullopt;
  }
  result.fallback = other->fallback;
  result.weights = other->weights;
  result.boundary = other->boundary;
  result.clamped_triangles = other->clamped_triangles;
  result.message += describe_fallback(*other, failure) + describe_attempts(other->map, settings);
  if (other->blend) {
    result.relaxation = other->blend->relaxed.status;
    result.scale_deviation_before = other->blend->scale_deviation_before;
    result.message += describe_relaxation(other->blend->relaxed);
  }
  take(std::move(other->map), result);
  return std::nullopt;
}

void Solver::State::unfold(const Pins& held, const std::optional<SolveFailure>& failure, const Progress& progress,
                           Parameterization& result) {
  Stopwatch watch(result.timings);
  take_unfolded(spectral_conformal::unfold(spectral, held, result.z, {false, true}, progress),
                failure ? failure->reason() : "", !held.empty(), result);
  watch.lap("unfolding");
}

void Solver::State::take_unfolded(UnfoldedMap&& unfolded, const std::string& failure, bool held,
                                  Parameterization& result) const {
  FoldFreeMap& map = unfolded.fold_free;
  if (unfolded.changed) {
    result.z = std::move(map.z);
    result.turning_number = unfolded.turning_number;
    result.eigenvalue = unfolded.eigenvalue;
    result.eigenvalue_of = EigenvalueOf::map;
    result.residual = unfolded.residual;
    // What stands in for a map that was refused may have been unfolded before, and is then moved apart.
    if (std::isnan(result.mean_qc_before) && !result.is_embedding) result.mean_qc_before = unfolded.mean_qc_before;
    result.unfolded += map.is_embedding ? map.flipped_before : map.flipped_before - map.flipped;
    result.is_embedding = result.is_embedding || map.is_embedding;
    // The quotient is that of the patch's own energy and form.
    result.weights = options.weights;
    result.boundary = options.boundary;
    result.clamped_triangles = 0;
    if (map.is_embedding) result.fallback = Fallback::tutte_embedding;
  }
  result.message +=
      describe_unfolding(map, failure, unfolded.mean_qc_before, unfolded.mean_qc, result.turning_number, held);
}

Parameterization Solver::State::solve(const SolveOptions& given, const Pins& pins, const Progress& progress) {
  SolveOptions settings = given;
  settings.method = method_with_pins(given, pins.size());
  const bool pinned = settings.method == Method::lscm;
  if (settings.method != Method::spectral && settings.has_extenders_or_rigidity()) {
    throw InvalidMesh("Extenders and hole rigidity need the method 'spectral', and pins that are soft, if any.");
  }
  // With fewer than three pins a similarity always fits. A single hard pin only moves the map.
  const Pins attractors = is_attracted(settings) && pins.size() > 2 ? pins : Pins{};
  const Pins held = pinned && pins.size() > 1 ? pins : Pins{};

  Parameterization result;
  result.method = settings.method;
  result.weights = options.weights;
  result.boundary = options.boundary;
  const Progress solving = part(progress, 0.0, options.fold_free ? 0.5 : 1.0);
  const std::optional<SolveFailure> failure =
      pinned ? solve_pinned(settings, held, solving, result) : solve_spectral(settings, attractors, solving, result);
  // Hard pins have no other map; everything else has the embedding.
  if (failure && (!options.fold_free || !held.empty())) throw SolveFailure(*failure);
  if (failure) spectral.drop_factor();  // the embedding has factors of its own
  if (options.fold_free) unfold(held, failure, part(progress, 0.5, 1.0), result);

  if (relaxation) {
    result.relaxation = relaxation;
    result.scale_deviation_before = scale_deviation_before;
  }
  if (result.relaxation) {
    result.scale_deviation = chart_distortion(patch, result.z).log2_scale_deviation;
    result.message +=
        describe_blend(options.area_blend, *result.relaxation, result.scale_deviation_before, result.scale_deviation);
  }
  if (pinned && pins.size() == 1) move_onto_pin(pins, result.z);
  if (!pinned && !pins.empty() && !fit_to_pins(result.z, pins)) {
    throw InvalidMesh("All pins have the same position, so the map would shrink to a point; move one of them.");
  }
  result.message += describe_unresolved(spectral.energy(), result.z) + repairs;
  if (!result.message.empty()) result.message.pop_back();  // the space after the last sentence
  report(progress, 1.0, "done");
  return result;
}

Solver::Solver(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& options,
               const std::vector<TriangleMetric>& metric) {
  Timings timings;
  Stopwatch watch(timings);
  state_ = std::make_unique<State>(chart, positions, options);
  const std::vector<TriangleShape>& shapes = state_->spectral.energy().shapes();
  for (std::size_t t = 0; t < metric.size(); ++t) {
    if (!is_positive_definite(metric[t]) && !shapes[t].clamped) {
      throw InvalidMesh("The metric of face " +
                        std::to_string(chart.faces[static_cast<std::size_t>(chart.triangle_face[t])]) +
                        " is not positive definite in double precision; both of its eigenvalues must be positive.");
    }
  }
  if (!metric.empty()) state_->spectral.stretch(metric);
  state_->has_metric = !metric.empty();
  watch.lap("assembly");
  state_->timings = std::move(timings);
}

Solver::Solver(const PolygonMesh& mesh, const PatchOptions& options, const SpaceMetric* metric) {
  Timings timings;
  Stopwatch watch(timings);
  Chart chart = single_chart(mesh);
  watch.lap("charts");
  *this = Solver(chart, chart.positions(mesh), options, chart_metric(mesh, chart, metric));
  state_->vertices = std::move(chart.vertices);
  state_->n_mesh_vertices = mesh.n_vertices;
  timings.insert(timings.end(), state_->timings.begin(), state_->timings.end());
  state_->timings.swap(timings);
}

Solver::~Solver() = default;
Solver::Solver(Solver&& other) noexcept = default;
Solver& Solver::operator=(Solver&& other) noexcept = default;

void Solver::factorize(const Progress& given) {
  const Listening listening(given, "ordering");
  const Progress& progress = listening.progress();
  const SpectralMap outcome = state_->factorize(progress);
  if (outcome.rejection != Rejection::none) throw failure_of(outcome, {});
}

Parameterization Solver::solve(const SolveOptions& options, const Pins& pins, const Progress& given) {
  const Listening listening(given, "ordering");
  const Progress& progress = listening.progress();
  const std::vector<int>& vertices = state_->vertices;
  if (vertices.empty()) return state_->solve(options, pins, progress);
  SolveOptions in_chart = options;
  for (Extender& extender : in_chart.extenders) {
    for (std::vector<int>* ends : {&extender.from, &extender.to}) {
      for (int& v : *ends) v = state_->chart_vertex(v, "has an extender");
    }
  }
  Pins chart_pins;
  for (const auto& [vertex, position] : pins) chart_pins[state_->chart_vertex(vertex, "is pinned")] = position;
  Parameterization result = state_->solve(in_chart, chart_pins, progress);
  ComplexVector z = ComplexVector::Zero(state_->n_mesh_vertices);
  for (std::size_t v = 0; v < vertices.size(); ++v) z[vertices[v]] = result.z[static_cast<Eigen::Index>(v)];
  result.z.swap(z);
  return result;
}

const ConformalEnergy& Solver::energy() const { return state_->spectral.energy(); }

double Solver::scale() const { return state_->patch.scale; }

}  // namespace spectral_conformal
