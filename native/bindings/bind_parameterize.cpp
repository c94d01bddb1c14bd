#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/options.h"
#include "bindings/progress_function.h"
#include "bindings/solve_record.h"
#include "bindings/space_metric.h"
#include "bindings/turns.h"
#include "mesh/chart_checks.h"
#include "parameterization/chart_metric.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

namespace {

/// A Solver on a mesh's one patch, which maps between the mesh's vertices and the chart's.
class PatchSolver {
 public:
  PatchSolver(const Array<double>& vertices, const Array<int>& triangles, const std::optional<Array<double>>& metric,
              const py::object& options)
      : n_vertices_(vertices.shape(0)) {
    const MeshArrays arrays = triangle_mesh(vertices, triangles);
    const PolygonMesh mesh = arrays.view();
    const std::vector<SpaceMetric> tensors = space_metric(vertices, triangles, metric);
    const PatchOptions patch_options = patch_options_of(options);
    const py::gil_scoped_release unlocked;
    const auto start = std::chrono::steady_clock::now();
    const Chart chart = single_chart(mesh);
    charts_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    vertices_ = chart.vertices;
    solver_ = std::make_unique<Solver>(chart, chart.positions(mesh), patch_options,
                                       chart_metric(mesh, chart, tensors.empty() ? nullptr : tensors.data()));
  }

  void factorize(const py::object& progress) {
    const Progress callback = progress_of(progress);
    const Turns::Turn turn(turns_);
    const py::gil_scoped_release unlocked;
    solver_->factorize(callback);
  }

  py::dict solve(const py::object& given_options, const PinList& pin_list, const ExtenderList& extenders,
                 const py::object& progress) {
    const Progress callback = progress_of(progress);
    SolveOptions options = solve_options_of(given_options);
    for (const auto& [from, to, strength] : extenders) {
      options.extenders.push_back(
          {{chart_vertex(from, "has an extender")}, {chart_vertex(to, "has an extender")}, strength});
    }
    Pins pins;
    for (const auto& [vertex, position] : pins_of(pin_list)) pins[chart_vertex(vertex, "is pinned")] = position;
    Parameterization solution;
    ComplexVector z;
    {
      const Turns::Turn turn(turns_);
      const py::gil_scoped_release unlocked;
      solution = solver_->solve(options, pins, callback);
      z = ComplexVector::Zero(n_vertices_);
      for (std::size_t v = 0; v < vertices_.size(); ++v) z[vertices_[v]] = solution.z[static_cast<Eigen::Index>(v)];
    }
    py::dict timings;
    timings["charts"] = charts_seconds_;
    for (const auto& [phase, seconds] : solution.timings) timings[phase.c_str()] = seconds;
    py::dict result = solve_record(solution);
    result["uv"] = real_view(z);
    result["timings"] = timings;
    return result;
  }

 private:
  int chart_vertex(int vertex, const char* role) const {
    const auto found = std::lower_bound(vertices_.begin(), vertices_.end(), vertex);
    if (found == vertices_.end() || *found != vertex) {
      throw InvalidMesh("Vertex " + std::to_string(vertex) + " " + role + ", but no triangle uses it.");
    }
    return static_cast<int>(found - vertices_.begin());
  }

  Turns turns_;
  Eigen::Index n_vertices_;
  double charts_seconds_ = 0;
  std::vector<int> vertices_;
  std::unique_ptr<Solver> solver_;
};

}  // namespace

void bind_parameterize(py::module_& module) {
  py::class_<PatchSolver>(module, "Solver", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const std::optional<Array<double>>&, const py::object&>())
      .def("factorize", &PatchSolver::factorize)
      .def("solve", &PatchSolver::solve);
}

}  // namespace spectral_conformal::python
