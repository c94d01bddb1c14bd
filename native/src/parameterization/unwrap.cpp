#include "spectral_conformal/unwrap.h"

#include <algorithm>
#include <new>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "parameterization/chart_loop.h"
#include "parameterization/chart_solver.h"
#include "parameterization/mesh_cut.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/kept_maps.h"

namespace spectral_conformal {

namespace {

/// Writes the UVs and the vertices of the corners of a chart, given its number in the result.
template <class Map>
void write_corners(const MeshCut& cut, std::size_t chart, const std::vector<int>& faces, const Map& map,
                   Unwrap& result) {
  const int first = cut.first_vertex[chart];
  for_each_polled(faces.size(), [&](std::size_t i) {
    const int face = faces[i];
    for (int c = cut.mesh.face_offsets[face]; c < cut.mesh.face_offsets[face + 1]; ++c) {
      const int vertex = cut.decomposition.chart_vertex_of_corner[c];
      const Complex uv = map(vertex);
      result.uv.row(c) << uv.real(), uv.imag();
      result.vertex_of_corner[c] = first + vertex;
      result.solved_corners[c] = true;
    }
  });
}

/// Charts without area, by their number in the result, each with the point that it becomes.
using Points = std::vector<std::pair<std::size_t, Complex>>;

/// Adds a chart to the result: writes the UVs of its corners and marks its acting extenders as used. Stores its map in
/// `kept`, which may be null, if memory allows.
void add(const MeshCut& cut, ChartSolution&& solution, Unwrap& result, Points& points, KeptMaps* kept = nullptr) {
  add_seconds(solution.timings, result.timings);
  if (solution.report.solved) {
    for (const std::size_t k : solution.acting) result.unused_extenders[k] = false;
    write_corners(
        cut, result.charts.size(), solution.report.faces, [&](int vertex) { return solution.z[vertex]; }, result);
  }
  if (solution.point) points.push_back({result.charts.size(), *solution.point});
  // The result of a chart without area depends on the other charts.
  if (kept && !solution.point && !solution.description.empty()) {
    try {
      UnwrappedChart report = solution.report;
      report.reused = false;
      kept->keep(std::move(solution.description), {std::move(report), std::move(solution.z)});
    } catch (const std::bad_alloc&) {
      // It will be solved again.
    }
  }
  result.charts.push_back(std::move(solution.report));
}

/// If another chart has a map, charts without area become points, which cover nothing; otherwise nothing is mapped.
void add_points(const MeshCut& cut, const Points& points, Unwrap& result) {
  const bool has_map = std::any_of(result.charts.begin(), result.charts.end(), [](const auto& c) { return c.solved; });
  if (!has_map) return;
  for (const auto& [i, point] : points) {
    UnwrappedChart& report = result.charts[i];
    report.solved = true;
    // L z = 0 for constant z.
    report.eigenvalue = report.residual = 0;
    report.mean_qc = report.max_qc = 1;
    report.steps = {{StepKind::shrunk_to_point}};
    report.image_area = 0;
    report.low = report.high = point;
    write_corners(
        cut, i, report.faces, [place = point](int) { return place; }, result);
  }
}

/// A result still without charts.
Unwrap empty_result(const MeshCut& cut, std::size_t n_extenders) {
  const int n_corners = cut.mesh.n_faces == 0 ? 0 : cut.mesh.face_offsets[cut.mesh.n_faces];
  Unwrap result;
  result.uv.setZero(n_corners, 2);
  result.vertex_of_corner.assign(static_cast<std::size_t>(n_corners), -1);
  result.solved_corners.assign(static_cast<std::size_t>(n_corners), false);
  result.chart_of_face = cut.decomposition.chart_of_face;
  result.unused_extenders.assign(n_extenders, true);
  result.charts.reserve(cut.decomposition.charts.size() + 1);
  return result;
}

void add_degenerate_faces(const MeshCut& cut, Unwrap& result) {
  const std::vector<int>& faces = cut.decomposition.degenerate_faces;
  if (faces.empty()) return;
  for (const int face : faces) result.chart_of_face[face] = static_cast<int>(result.charts.size());
  UnwrappedChart unusable;
  unusable.faces = faces;
  unusable.steps = {{StepKind::degenerate_faces}};
  result.charts.push_back(std::move(unusable));
}

std::vector<std::size_t> n_faces_of(const std::vector<Chart>& charts) {
  std::vector<std::size_t> result;
  result.reserve(charts.size());
  for (const Chart& chart : charts) result.push_back(chart.faces.size());
  return result;
}

}  // namespace

Unwrap unwrap(const PolygonMesh& mesh, const UnwrapOptions& options, const Progress& given, KeptMaps* kept) {
  const CancellationScope scope(given, "charts");
  const Progress& progress = scope.progress();
  report(progress, 0.0, "charts");
  Timings timings;
  Stopwatch watch(timings);
  MeshCut cut = cut_mesh(mesh, options.corner_pins);
  watch.lap("charts");
  Unwrap result = empty_result(cut, options.extenders.size());
  result.timings.swap(timings);
  std::vector<Chart>& charts = cut.decomposition.charts;
  const std::vector<ChartExtenders> extenders = extenders_of_charts(cut, options.extenders);
  const std::vector<LinearEquations> constraints = equations_of_charts(cut, options.constraints);
  Points points;
  ChartWork work;
  work.solve = [&](int i, const Progress& charts_progress) {
    Chart& chart = charts[static_cast<std::size_t>(i)];
    ChartSolver solver(chart_task(cut, chart, options, constraints[static_cast<std::size_t>(i)]));
    ChartSolution solution = solver.solve(extenders[static_cast<std::size_t>(i)], options.solve.hole_rigidity,
                                          options.solve.tolerance, charts_progress, kept);
    // Each frees its memory before the next solve.
    const Chart done = std::move(chart);
    return solution;
  };
  work.give_up = [&](int i) {
    return out_of_memory(chart_task(cut, charts[static_cast<std::size_t>(i)], options, {}));
  };
  work.write = [&](ChartSolution&& solution) { add(cut, std::move(solution), result, points, kept); };
  solve_charts(n_faces_of(charts), progress, work);
  add_points(cut, points, result);
  add_degenerate_faces(cut, result);
  return result;
}

struct Unwrapper::State {
  MeshCut cut;
  const double* corner_uv;  ///< as given first
  std::vector<ChartSolver> charts = {};
};

Unwrapper Unwrapper::of(const PolygonMesh& mesh, const UnwrapOptions& options) {
  std::unique_ptr<State> state(new State{cut_mesh(mesh, options.corner_pins), options.corner_pins.uv});
  const std::vector<Chart>& charts = state->cut.decomposition.charts;
  const std::vector<LinearEquations> constraints = equations_of_charts(state->cut, options.constraints);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    state->charts.emplace_back(chart_task(state->cut, charts[i], options, constraints[i]));
  }
  return Unwrapper(std::move(state));
}

Unwrapper::Unwrapper(std::unique_ptr<State> state) : state_(std::move(state)) {}
Unwrapper::~Unwrapper() = default;
Unwrapper::Unwrapper(Unwrapper&& other) noexcept = default;

Unwrap Unwrapper::solve(const std::vector<VertexExtender>& extenders, std::optional<double> hole_rigidity,
                        double tolerance, const double* corner_uv, const Progress& given, bool measures) {
  const CancellationScope scope(given, "ordering");
  const MeshCut& cut = state_->cut;
  Unwrap result = empty_result(cut, extenders.size());
  const double* pinned_at = corner_uv != nullptr ? corner_uv : state_->corner_uv;
  const std::vector<ChartExtenders> own = extenders_of_charts(cut, extenders);
  Points points;
  ChartWork work;
  work.solve = [&](int i, const Progress& charts_progress) {
    const auto k = static_cast<std::size_t>(i);
    state_->charts[k].move_pins(pinned_at);
    return state_->charts[k].solve(own[k], hole_rigidity, tolerance, charts_progress, nullptr, measures);
  };
  work.give_up = [&](int i) { return out_of_memory(state_->charts[static_cast<std::size_t>(i)].task()); };
  work.write = [&](ChartSolution&& solution) { add(cut, std::move(solution), result, points); };
  solve_charts(n_faces_of(cut.decomposition.charts), scope.progress(), work);
  add_points(cut, points, result);
  add_degenerate_faces(cut, result);
  return result;
}

}  // namespace spectral_conformal
