#include "spectral_conformal/parameterize.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "graph/numbering.h"
#include "mesh/chart_checks.h"
#include "mesh/charts.h"
#include "parameterization/area_blend.h"
#include "parameterization/attempts.h"
#include "parameterization/chart_metric.h"
#include "parameterization/constrained_map.h"
#include "parameterization/fallbacks.h"
#include "parameterization/held_map.h"
#include "parameterization/hole_rigidity.h"
#include "parameterization/patch_map.h"
#include "parameterization/polishing.h"
#include "parameterization/recipe.h"
#include "parameterization/unfolding.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

bool is_attracted(const SolveOptions& options) { return options.method == Method::spectral && options.soft_pins > 0; }

std::vector<Step> repairs_of(const Chart& chart, int degenerate_triangles) {
  std::vector<Step> steps;
  const auto add = [&steps](StepKind kind, int count) {
    if (count > 0) steps.push_back(counted(kind, count));
  };
  add(StepKind::reoriented_faces, chart.reversed_faces);
  add(StepKind::duplicate_faces, static_cast<int>(chart.duplicates.size()));
  add(StepKind::fan_splits, chart.self_intersecting_polygons);
  add(StepKind::degenerate_triangles, degenerate_triangles);
  return steps;
}

/// Counts the triangles so small that their corners coincide to the precision of the coordinates z (V,).
int count_unresolved(const ConformalEnergy& energy, const ComplexVector& z) {
  const double min_length = sum_rounding * (z.array() - z.mean()).abs().maxCoeff();
  int count = 0;
  for (std::size_t t = 0; t + energy.n_virtual() < energy.triangles().size(); ++t) {
    const auto& [a, b, c] = energy.triangles()[t];
    const double longest = std::max(std::norm(z[b] - z[a]), std::norm(z[c] - z[a]));
    if (longest < min_length * min_length && !energy.shapes()[t].clamped) ++count;
  }
  return count;
}

PreparedPatch prepared_patch(const Chart& chart, const Eigen::Ref<const Positions>& positions,
                             const PatchOptions& options, const std::vector<TriangleMetric>& metric) {
  Timings timings;
  Stopwatch watch(timings);
  auto patch = std::make_shared<const NormalizedPatch>(normalized_patch(chart, positions, options.fill_holes));
  SpectralProblem problem = spectral_problem(std::move(patch), options.weights, options.boundary, options.backend);
  const std::vector<TriangleShape>& shapes = problem.energy.shapes();
  for (std::size_t t = 0; t < metric.size(); ++t) {
    if (is_positive_definite(metric[t]) || shapes[t].clamped) continue;
    throw InvalidMesh(Rejection::metric_not_positive, chart.faces[static_cast<std::size_t>(chart.triangle_face[t])]);
  }
  if (!metric.empty()) problem.stretch(metric);
  std::vector<Step> repairs = repairs_of(chart, problem.energy.clamped_triangles());
  watch.lap("assembly");
  return {options, std::move(problem), !metric.empty(), std::move(repairs), {}, std::move(timings)};
}

/// The task of solving a patch with these options and pins. Throws InvalidMesh for input that the method does not
/// support.
SolveTask task_of(PreparedPatch& patch, const SolveOptions& options, const Pins& pins) {
  const bool is_constrained = !options.constraints.empty();
  if (is_constrained) {
    const bool holds = pins.size() > 1 || !options.constraints.held.empty();
    const bool solves_held = options.method == Method::lscm && holds;
    if (options.method != Method::spectral && !solves_held) throw InvalidMesh(Rejection::method_without_constraints);
  }
  SolveTask task{patch, options, pins};
  task.options.method = method_with_pins(options, pins.size());
  // At a tolerance coarser than single precision, as while a slider moves, a start near the solution saves solves.
  if (!(options.tolerance > single_epsilon)) patch.problem.earlier = {};
  // With fewer than three pins a similarity always fits; constraints exclude its turn. A single hard pin only moves the
  // map.
  const bool holds_any = !options.constraints.held.empty();
  if (is_attracted(options) && pins.size() > (holds_any ? 0 : is_constrained ? 1 : 2)) task.attractors = pins;
  const bool holds_pins = task.options.method == Method::lscm && task.attractors.empty();
  if (holds_pins && (pins.size() > 1 || holds_any)) task.held = pins;
  const bool are_soft_refused =
      task.is_held() ? options.hole_rigidity.value_or(0) != 0 : options.has_extenders_or_rigidity();
  if (task.options.method != Method::spectral && are_soft_refused)
    throw InvalidMesh(Rejection::method_without_extenders);
  // A map requested as LSCM stays as it is.
  if (options.method != Method::spectral) task.options.polish = Polish::off;
  // With a metric, the map is not judged by the distortion that would choose the rigidity.
  const bool is_chosen = task.is_free() && !patch.has_metric && !(patch.options.area_blend > 0);
  std::optional<double>& rigidity = task.options.hole_rigidity;
  if (patch.problem.patch->inner.empty() || (!rigidity && !is_chosen)) rigidity = 0;
  return task;
}

/// What is known before the solve. rejection: why there can be no map, if so.
PatchMap unsolved(const SolveTask& task, const std::optional<Step>& rejection) {
  PatchMap map;
  map.rejection = rejection;
  map.result.method = task.options.method;
  map.result.weights = task.patch.options.weights;
  map.result.boundary = task.patch.options.boundary;
  map.result.timings = task.patch.timings;
  if (task.patch.blend) {
    map.result.relaxation = task.patch.blend->status;
    map.result.scale_deviation_before = task.patch.blend->scale_deviation_before;
  }
  return map;
}

/// Stage: fixes the similarity that the energy leaves free.
PatchMap placed(const SolveTask& task, PatchMap map) {
  if (task.is_constrained() || task.is_held()) {
    Stopwatch watch(map.result.timings);
    map.found.z = map.found.whole.head(task.patch.problem.patch->n_vertices);
    task.is_held() ? place_held(task, map.found.z) : place_constrained(task, map.found.z);
    map.take_found();
    watch.lap("placement");
    return map;
  }
  map.found = placed_map(task.patch.problem, std::move(map.found), map.result.timings);
  map.take_found();
  return map;
}

/// A remark on flipped triangles of a map that is pulled, constrained or unfolded: placing rounds every coordinate,
/// which can flip a triangle that is as small as their precision. Those of other maps are only counted.
void remark_on_folds(const SolveTask& task, PatchMap& map) {
  const bool is_shaped = task.options.has_extenders() || !task.attractors.empty() || task.is_constrained();
  const auto& steps = map.result.steps;
  const auto is_said = [](const Step& step) { return step.kind == StepKind::still_flipped; };
  if (!(is_shaped || task.options.fold_free) || std::any_of(steps.begin(), steps.end(), is_said)) return;
  const StepKind kind = is_shaped ? StepKind::folds : StepKind::still_flipped;
  Step step = counted(kind, n_flipped_of_triangulation(*task.patch.problem.patch, map.result.z));
  step.constraint = constraint_of(task.options);
  if (step.constraint == Constraint::none && (is_shaped || task.is_held())) step.constraint = Constraint::pins;
  if (step.count > 0) map.add(step);
}

/// Stage: adds the remarks on the patch and on the precision of the map.
PatchMap remarked(const SolveTask& task, PatchMap map) {
  const PreparedPatch& patch = task.patch;
  remark_on_folds(task, map);
  const int unresolved = count_unresolved(patch.problem.energy, map.result.z);
  if (unresolved > 0) map.add(counted(StepKind::unresolved_triangles, unresolved));
  for (const Step& repair : patch.repairs) map.add(repair);
  if (patch.blend && patch.blend->flipped > 0) {
    map.add(counted(StepKind::relaxed_with_flips, patch.blend->flipped));
  }
  return map;
}

}  // namespace

bool SolveOptions::has_extenders() const {
  return std::any_of(extenders.begin(), extenders.end(), [](const Extender& e) { return e.strength != 0; });
}

bool SolveOptions::has_extenders_or_rigidity() const { return hole_rigidity.value_or(0) != 0 || has_extenders(); }

Method method_with_pins(const SolveOptions& options, std::size_t n_pins) {
  if (!options.constraints.empty()) {
    // A single pin only defines a translation, which needs no other method.
    const bool is_held = (n_pins > 1 && !is_attracted(options)) || !options.constraints.held.empty();
    return is_held ? Method::lscm : options.method;
  }
  // Fewer pins only define a similarity, which needs no other method.
  if (n_pins < 3 || options.method == Method::lscm || is_attracted(options)) return options.method;
  if (options.method == Method::spectral) return Method::lscm;
  throw InvalidMesh(Rejection::method_without_pins);
}

struct Solver::State {
  PreparedPatch patch;
  // For a solver made from a mesh; empty otherwise.
  std::vector<int> vertices = {};  ///< the mesh vertex of each chart vertex, ascending
  int n_mesh_vertices = 0;
  bool is_whole_mesh = false;  ///< whether chart and mesh have the same vertices

  /// Throws InvalidMesh with this reason if no triangle uses the vertex.
  int chart_vertex(int mesh_vertex, Rejection unused) const;
  SolveOptions in_chart(const SolveOptions& options) const;
  Pins in_chart(const Pins& pins) const;
  ComplexVector on_mesh(ComplexVector&& z) const;
};

int Solver::State::chart_vertex(int mesh_vertex, Rejection unused) const {
  const auto found = std::lower_bound(vertices.begin(), vertices.end(), mesh_vertex);
  if (found == vertices.end() || *found != mesh_vertex) throw InvalidMesh(unused, mesh_vertex);
  return static_cast<int>(found - vertices.begin());
}

SolveOptions Solver::State::in_chart(const SolveOptions& options) const {
  SolveOptions result = options;
  if (vertices.empty()) return result;
  if (!options.constraints.empty()) {
    result.constraints =
        options.constraints.renumbered(indices_in(vertices, static_cast<std::size_t>(n_mesh_vertices)));
  }
  for (Extender& extender : result.extenders) {
    for (std::vector<int>* ends : {&extender.from, &extender.to}) {
      for (int& v : *ends) v = chart_vertex(v, Rejection::unused_extender_vertex);
    }
  }
  return result;
}

Pins Solver::State::in_chart(const Pins& pins) const {
  if (vertices.empty()) return pins;
  Pins result;
  for (const auto& [vertex, position] : pins) result[chart_vertex(vertex, Rejection::unused_pinned_vertex)] = position;
  return result;
}

ComplexVector Solver::State::on_mesh(ComplexVector&& z) const {
  if (vertices.empty() || is_whole_mesh) return std::move(z);
  ComplexVector result = ComplexVector::Zero(n_mesh_vertices);
  for (std::size_t v = 0; v < vertices.size(); ++v) result[vertices[v]] = z[static_cast<Eigen::Index>(v)];
  return result;
}

Parameterization Solver::solve(const SolveOptions& options, const Pins& pins, const Progress& given) {
  const CancellationScope scope(given, "ordering");
  const Progress& progress = scope.progress();
  const SolveTask task = task_of(state_->patch, state_->in_chart(options), state_->in_chart(pins));
  if (task.is_constrained()) {
    const Step step = contradiction(*state_->patch.problem.patch, task.options.constraints, task.held, task.attractors);
    if (step.reason != Rejection::none) throw InvalidMesh(with_vertices(step, state_->vertices));
  }
  // The fractions of progress, here and in area_blend.cpp, estimate the time of the phases: a blend takes many
  // factorizations, a factorization somewhat longer than the eigenproblem. They only have to increase.
  const bool is_fold_free = options.fold_free;
  const Progress solving = part(progress, 0.0, is_fold_free ? 0.5 : 1.0);
  const double begun = state_->patch.options.area_blend > 0 ? 0.5 : 0.0;

  // From the patch to its map. recipe.h says which stages act; each receives the map of the previous one, or the reason
  // for its lack.
  const Recipe recipe = recipe_of(task);
  PatchMap map = unsolved(task, blend_once(state_->patch, part(solving, 0.0, begun)));  // trades for areas
  const auto apply = [&](auto stage, const Progress& share) { map = stage(task, std::move(map), share); };
  const auto begins_with = [&](Recipe::First first) { return !map.rejection && recipe.first == first; };
  const Progress solve_share = part(solving, begun, 0.95);
  const Progress late = part(solving, 0.95, 0.95);
  if (begins_with(Recipe::First::held)) apply(held, solve_share);                     // LSCM
  if (begins_with(Recipe::First::rigid_holes)) apply(with_rigid_holes, solve_share);  // the paper's, several B
  if (begins_with(Recipe::First::spectral)) apply(spectral, solve_share);             // the paper's: spectral_map.h
  if (recipe.retries) apply(retried, late);                                           // if it fails its checks
  if (recipe.nears_free) apply(nearest_to_free, late);                                // or one near the free map
  if (recipe.polishes && !map.rejection) apply(polished, part(solving, 0.95, 1.0));   // on to a lower mean QC
  if (recipe.replaces && map.rejection && map.result.hole_rigidity == 0) apply(replaced, late);  // by another map
  if (!map.rejection && map.result.z.size() == 0) map = placed(task, std::move(map));  // upright, in the size in 3D
  if (map.rejection ? recipe.embeds : recipe.unfolds) apply(unfolded, part(progress, 0.5, 1.0));
  if (map.rejection) throw SolveFailure(*map.rejection);
  map = measured_blend(task, std::move(map));
  if (recipe.fits_to_pins) map = fitted_to_pins(task, std::move(map));
  map = remarked(task, std::move(map));

  map.result.z = state_->on_mesh(std::move(map.result.z));
  report(progress, 1.0, "done");
  return std::move(map.result);
}

void Solver::factorize(const Progress& given) {
  const CancellationScope scope(given, "ordering");
  const Progress& progress = scope.progress();
  PreparedPatch& patch = state_->patch;
  const double begun = patch.options.area_blend > 0 ? 0.8 : 0.0;
  const std::optional<Step> rejection = blend_once(patch, part(progress, 0.0, begun));
  if (rejection) throw SolveFailure(*rejection);
  Stopwatch watch(patch.timings);
  patch.problem.factorize(Method::spectral, first_attempt.relative_shift, part(progress, begun, 1.0));
  watch.lap("factorization");
  if (patch.problem.is_factored()) return;
  SpectralMap none;
  none.rejection = Rejection::not_factorized;
  none.shift = patch.problem.factor.shift();
  throw SolveFailure(rejected(none, {}));
}

Solver Solver::of(const Chart& chart, const Eigen::Ref<const Positions>& positions, const PatchOptions& options,
                  const std::vector<TriangleMetric>& metric) {
  return Solver(std::unique_ptr<State>(new State{prepared_patch(chart, positions, options, metric)}));
}

Solver Solver::of(const PolygonMesh& mesh, const PatchOptions& options, const SpaceMetric* metric) {
  Timings timings;
  Stopwatch watch(timings);
  Chart chart = single_chart(mesh);
  watch.lap("charts");
  Solver result = of(chart, chart.positions(mesh), options, chart_metric(mesh, chart, metric));
  State& state = *result.state_;
  std::vector<int> all(static_cast<std::size_t>(mesh.n_vertices));
  std::iota(all.begin(), all.end(), 0);
  state.is_whole_mesh = chart.vertices == all;
  state.vertices = std::move(chart.vertices);
  state.n_mesh_vertices = mesh.n_vertices;
  timings.insert(timings.end(), state.patch.timings.begin(), state.patch.timings.end());
  state.patch.timings.swap(timings);
  return result;
}

Solver::Solver(std::unique_ptr<State> state) : state_(std::move(state)) {}
Solver::~Solver() = default;
Solver::Solver(Solver&& other) noexcept = default;

const ConformalEnergy& Solver::energy() const { return state_->patch.problem.energy; }

double Solver::scale() const { return state_->patch.problem.patch->scale; }

}  // namespace spectral_conformal
