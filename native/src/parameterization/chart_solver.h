#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "parameterization/mesh_cut.h"
#include "parameterization/stopwatch.h"
#include "spectral_conformal/kept_maps.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal {

/// The problem to solve on a chart.
struct ChartTask {
  const MeshCut& cut;
  const Chart& chart;
  const UnwrapOptions& given;
  UnwrappedChart report;     ///< before a solve
  Pins pins;                 ///< on the chart's vertices
  SolveOptions options;      ///< without extenders and hole rigidity
  bool is_possible = false;  ///< false: the report says why
};

/// `cut`, `chart` and `options` must outlive the task. constraints: on the chart's vertices.
ChartTask chart_task(const MeshCut& cut, const Chart& chart, const UnwrapOptions& options,
                     const LinearEquations& constraints);

/// A map of a chart, if there is one.
struct ChartSolution {
  UnwrappedChart report;
  ComplexVector z;
  std::vector<std::size_t> acting;  ///< numbers of the extenders that act
  Timings timings;
  std::string description;       ///< see describe_chart; empty if nothing is to be kept
  std::optional<Complex> point;  ///< image of a chart without area if other charts have maps
};

/// The solution of a chart for which memory is too small.
ChartSolution out_of_memory(const ChartTask& task);

/// Solves one chart, repeatedly; reports failures instead of throwing.
class ChartSolver {
 public:
  explicit ChartSolver(ChartTask task) : task_(std::move(task)) {}
  const ChartTask& task() const { return task_; }

  /// Moves the pinned corners, as in Unwrapper::solve.
  void move_pins(const double* corner_uv);
  /// With `kept`, which is only read, takes the map from there if present; this must then be the first solve. Throws
  /// std::bad_alloc after dropping its factor, since other charts need the memory. measures: see Unwrapper::solve.
  ChartSolution solve(const ChartExtenders& extenders, std::optional<double> hole_rigidity, double tolerance,
                      const Progress& progress, const KeptMaps* kept = nullptr, bool measures = true);

 private:
  bool reuse(const KeptMaps& kept, const Positions& positions, const std::vector<TriangleMetric>& metric,
             const SolveOptions& options, ChartSolution& result) const;
  void solve(const SolveOptions& options, const Progress& progress, bool measures, ChartSolution& result);

  ChartTask task_;
  std::optional<Step> pin_problem_;  ///< why the pins have no valid positions, if they have none
  std::unique_ptr<Solver> solver_;   ///< made by the first solve
};

}  // namespace spectral_conformal
