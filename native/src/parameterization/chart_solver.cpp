#include "parameterization/chart_solver.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "conformal/conformal_energy.h"
#include "mesh/chart_checks.h"
#include "parameterization/chart_description.h"
#include "parameterization/chart_metric.h"
#include "parameterization/constrained_map.h"
#include "quality/overlap.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {

namespace {

/// The largest quasi-conformal distortion of a face, defined as in measure_face_distortion: the mean over its
/// triangles, weighted by their area in 3D.
double largest_of_a_face(const Chart& chart, const Distortion& distortion) {
  double largest = 1;
  const std::vector<int>& triangles = distortion.triangulation;
  for (std::size_t k = 0; k < triangles.size();) {
    const int face = chart.triangle_face[static_cast<std::size_t>(triangles[k])];
    double area = 0;
    double qc = 0;
    // The triangles of a face are consecutive.
    for (; k < triangles.size() && chart.triangle_face[static_cast<std::size_t>(triangles[k])] == face; ++k) {
      const int t = triangles[k];
      if (distortion.area[t] == 0) continue;
      area += distortion.area[t];
      qc += distortion.area[t] * distortion.qc[t];
    }
    if (area > 0) largest = std::max(largest, qc / area);
  }
  return largest;
}

/// Sets mean_qc, max_qc, scale_deviation, flipped and image_area of a solved chart.
void measure(const Chart& chart, const ConformalEnergy& energy, const ComplexVector& z, UnwrappedChart& report) {
  const Distortion distortion = measure_distortion(energy.shapes(), chart.triangles, chart.triangle_weights, z);
  report.mean_qc = distortion.mean_qc;
  // A blend has measured it already.
  if (std::isnan(report.scale_deviation)) report.scale_deviation = distortion.log2_scale_deviation;
  report.max_qc = largest_of_a_face(chart, distortion);
  report.image_area = 0;
  int last_flipped = -1;
  for (const int t : distortion.triangulation) {
    report.image_area += std::abs(distortion.image_area[t]);
    const int face = chart.triangle_face[static_cast<std::size_t>(t)];
    if (!distortion.flipped[static_cast<std::size_t>(t)] || face == last_flipped) continue;
    last_flipped = face;
    ++report.flipped;
  }
}

/// Adds the pins of mesh vertices to their copies in a chart, except where corners have pins.
void add_vertex_pins(const PinSplitMesh& split, const Chart& chart, const Pins& vertex_pins, Pins& pins) {
  if (vertex_pins.empty()) return;
  for (int v = 0; v < chart.n_vertices(); ++v) {
    const auto pin = vertex_pins.find(split.original_vertex(chart.vertices[static_cast<std::size_t>(v)]));
    if (pin != vertex_pins.end()) pins.emplace(v, pin->second);
  }
}

/// The pins of the chart, with the corners' at these positions. Throws InvalidMesh if one is not finite.
Pins pins_at(const ChartTask& task, const double* corner_uv) {
  const CornerPins corner_pins{task.given.corner_pins.pinned, corner_uv};
  Pins pins = chart_pins(task.cut.mesh, task.chart, task.cut.decomposition.chart_vertex_of_corner, corner_pins);
  add_vertex_pins(task.cut.split, task.chart, task.given.vertex_pins, pins);
  return pins;
}

/// A step with the mesh's numbers for vertices.
Step in_mesh(const ChartTask& task, const Step& step) {
  std::vector<int> vertices = task.chart.vertices;
  for (int& v : vertices) v = task.cut.split.original_vertex(v);
  return with_vertices(step, vertices);
}

Complex mean_of(const Pins& pins) {
  Complex sum = 0;
  for (const auto& [vertex, pin] : pins) sum += pin;
  return sum / static_cast<double>(std::max<std::size_t>(pins.size(), 1));
}

}  // namespace

ChartTask chart_task(const MeshCut& cut, const Chart& chart, const UnwrapOptions& options,
                     const LinearEquations& constraints) {
  ChartTask task{cut, chart, options, {}, {}, options.solve};
  UnwrappedChart& report = task.report;
  report.n_vertices = chart.n_vertices();
  report.method = options.solve.method;
  report.weights = options.patch.weights;
  report.boundary = options.patch.boundary;
  report.faces = chart.faces;
  report.faces.insert(report.faces.end(), chart.duplicates.begin(), chart.duplicates.end());
  std::sort(report.faces.begin(), report.faces.end());
  try {
    task.pins = pins_at(task, options.corner_pins.uv);
    report.n_pins = static_cast<int>(task.pins.size());
    task.options.extenders.clear();
    task.options.constraints = constraints;
    task.options.hole_rigidity = 0;
    report.method = method_with_pins(task.options, task.pins.size());
    task.is_possible = true;
  } catch (const InvalidMesh& problem) {
    report.steps = {problem.step()};
  }
  return task;
}

ChartSolution out_of_memory(const ChartTask& task) {
  ChartSolution result{task.report, {}, {}, {}, {}, {}};
  result.report.steps = {counted(StepKind::out_of_memory, static_cast<int>(task.report.faces.size()))};
  return result;
}

void ChartSolver::move_pins(const double* corner_uv) {
  if (!task_.is_possible || task_.given.corner_pins.pinned == nullptr) return;
  try {
    task_.pins = pins_at(task_, corner_uv);
    pin_problem_.reset();
  } catch (const InvalidMesh& problem) {
    pin_problem_ = problem.step();
  }
}

ChartSolution ChartSolver::solve(const ChartExtenders& extenders, std::optional<double> hole_rigidity, double tolerance,
                                 const Progress& progress, const KeptMaps* kept, bool measures) {
  ChartSolution result{task_.report, {}, {}, {}, {}, {}};
  if (!task_.is_possible) return result;
  if (pin_problem_) {
    result.report.steps = {*pin_problem_};
    return result;
  }
  SolveOptions options = task_.options;
  options.tolerance = tolerance;
  // Between pins only, it has no effect.
  const auto can_act = [&](const Extender& extender) {
    const auto is_free = [&](int v) { return task_.pins.count(v) == 0; };
    return task_.report.method == Method::spectral ||
           std::any_of(extender.from.begin(), extender.from.end(), is_free) ||
           std::any_of(extender.to.begin(), extender.to.end(), is_free);
  };
  if (task_.options.method == Method::spectral) {
    options.extenders = extenders.extenders;
    if (task_.report.method == Method::spectral) options.hole_rigidity = hole_rigidity;
    for (std::size_t k = 0; k < extenders.numbers.size(); ++k) {
      if (can_act(options.extenders[k])) result.acting.push_back(extenders.numbers[k]);
    }
  }
  const Chart& chart = task_.chart;
  try {
    if (!solver_) {
      const Positions positions = chart.positions(task_.cut.mesh);
      const std::vector<TriangleMetric> metric = chart_metric(task_.cut.mesh, chart, task_.given.metric);
      if (kept && reuse(*kept, positions, metric, options, result)) return result;
      solver_ = std::make_unique<Solver>(Solver::of(chart, positions, task_.given.patch, metric));
    }
    solve(options, progress, measures, result);
  } catch (const InvalidMesh& problem) {
    result.report.steps = {in_mesh(task_, problem.step())};
    if (has_no_area(chart, chart.positions(task_.cut.mesh))) result.point = mean_of(task_.pins);
  } catch (const SolveFailure& problem) {
    result.report.steps = {problem.step()};
  } catch (const std::bad_alloc&) {
    solver_.reset();
    throw;
  }
  return result;
}

/// Reuses the kept map of the chart; false if there is none.
bool ChartSolver::reuse(const KeptMaps& kept, const Positions& positions, const std::vector<TriangleMetric>& metric,
                        const SolveOptions& options, ChartSolution& result) const {
  Stopwatch watch(result.timings);
  result.description = describe_chart(task_.chart, positions, metric, task_.given.patch, options, task_.pins);
  const KeptMaps::Map* map = kept.find(result.description);
  if (map) {
    result.report = map->report;
    result.report.reused = true;
    result.z = map->z;
  }
  watch.lap("kept maps");
  return map != nullptr;
}

void ChartSolver::solve(const SolveOptions& options, const Progress& progress, bool measures, ChartSolution& result) {
  UnwrappedChart& report = result.report;
  Parameterization solution = solver_->solve(options, task_.pins, progress);
  static_cast<SolveRecord&>(report) = solution;
  add_seconds(solution.timings, result.timings);
  Stopwatch watch(result.timings);
  if (measures) {
    const auto measure_one = [&](int which, const Progress&) {
      if (which == 0) measure(task_.chart, solver_->energy(), solution.z, report);
      if (which == 1) report.overlapping = static_cast<int>(overlapping_faces(task_.chart, solution.z).size());
    };
    run_in_parallel(2, measure_one, {}, "quality", max_threads_for(task_.chart.triangles.size()));
  } else {
    report.flipped = report.overlapping = -1;
  }
  report.area = solver_->energy().area() * solver_->scale() * solver_->scale();
  report.low = {solution.z.real().minCoeff(), solution.z.imag().minCoeff()};
  report.high = {solution.z.real().maxCoeff(), solution.z.imag().maxCoeff()};
  watch.lap("quality");
  report.solved = true;
  result.z = std::move(solution.z);
}

}  // namespace spectral_conformal
