#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/options.h"
#include "bindings/progress_function.h"
#include "bindings/solve_record.h"
#include "bindings/space_metric.h"
#include "bindings/turns.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::python {

namespace {

/// A Solver for the one patch of a mesh; Python threads may share it.
class PatchSolver {
 public:
  PatchSolver(const Array<double>& vertices, const Array<int>& triangles, const std::optional<Array<double>>& metric,
              const py::object& options, const py::object& progress) {
    const MeshArrays arrays = triangle_mesh(vertices, triangles);
    const PolygonMesh mesh = arrays.view();
    const std::vector<SpaceMetric> tensors = space_metric(vertices, triangles, metric);
    const PatchOptions patch_options = patch_options_of(options);
    const PolledWork polling("charts", progress);
    solver_.emplace(Solver::of(mesh, patch_options, tensors.empty() ? nullptr : tensors.data()));
  }

  void factorize(const py::object& progress) {
    const Progress callback = progress_of(progress);
    const Turns::Turn turn(turns_);
    const py::gil_scoped_release unlocked;
    solver_->factorize(callback);
  }

  py::dict solve(const py::object& given_options, const PinList& pin_list, const ExtenderList& extenders,
                 std::optional<EquationArrays> constraints, const py::object& progress) {
    const Progress callback = progress_of(progress);
    SolveOptions options = solve_options_of(given_options);
    for (const auto& [from, to, strength, half] : extenders) {
      options.extenders.push_back({{from}, {to}, strength, half});
    }
    options.constraints = equations_of(std::move(constraints));
    const Pins pins = pins_of(pin_list);
    Parameterization solution;
    {
      const Turns::Turn turn(turns_);
      const py::gil_scoped_release unlocked;
      solution = solver_->solve(options, pins, callback);
    }
    py::dict timings;
    for (const auto& [phase, seconds] : solution.timings) timings[phase.c_str()] = seconds;
    py::dict result = solve_record(solution);
    result["uv"] = real_view(solution.z);
    result["timings"] = timings;
    return result;
  }

 private:
  Turns turns_;
  std::optional<Solver> solver_;
};

}  // namespace

void bind_parameterize(py::module_& module) {
  py::class_<PatchSolver>(module, "Solver", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const std::optional<Array<double>>&, const py::object&,
                    const py::object&>())
      .def("factorize", &PatchSolver::factorize)
      .def("solve", &PatchSolver::solve);
}

}  // namespace spectral_conformal::python
