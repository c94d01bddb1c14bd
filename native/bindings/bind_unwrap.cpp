#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/options.h"
#include "bindings/progress_function.h"
#include "bindings/space_metric.h"
#include "bindings/turns.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

namespace {

py::dict result_of(const Unwrap& unwrapped) {
  py::array_t<double> uv({static_cast<py::ssize_t>(unwrapped.uv.rows()), static_cast<py::ssize_t>(2)});
  std::copy_n(unwrapped.uv.data(), unwrapped.uv.size(), uv.mutable_data());
  py::list charts;
  for (const UnwrappedChart& chart : unwrapped.charts) {
    charts.append(py::dict(py::arg("faces") = copy(chart.faces), py::arg("status") = chart.solved ? "solved" : "failed",
                           py::arg("message") = chart.message, py::arg("eigenvalue") = chart.eigenvalue,
                           py::arg("residual") = chart.residual, py::arg("iterations") = chart.iterations,
                           py::arg("turning_number") = chart.turning_number, py::arg("mean_qc") = chart.mean_qc,
                           py::arg("max_qc") = chart.max_qc, py::arg("flipped") = chart.flipped,
                           py::arg("overlapping") = chart.overlapping, py::arg("unfolded") = chart.unfolded,
                           py::arg("is_embedding") = chart.is_embedding,
                           py::arg("mean_qc_before") = chart.mean_qc_before, py::arg("method") = name_of(chart.method),
                           py::arg("n_pins") = chart.n_pins, py::arg("n_vertices") = chart.n_vertices,
                           py::arg("area") = chart.area));
  }
  return py::dict(py::arg("uv") = uv, py::arg("solved_corners") = copy(unwrapped.solved_corners),
                  py::arg("chart_of_face") = copy(unwrapped.chart_of_face), py::arg("charts") = charts,
                  py::arg("unused_extenders") = copy(unwrapped.unused_extenders));
}

/// A mesh to unwrap and its options, with the arrays they refer to.
struct UnwrapArguments {
  MeshArrays arrays;
  std::optional<Array<bool>> pinned_corners;
  std::optional<Array<double>> corner_uv;
  std::vector<SpaceMetric> metric;
  UnwrapOptions options;

  UnwrapArguments(const Array<double>& vertices, const Array<int>& face_offsets, const Array<int>& corner_vertices,
                  std::optional<Array<int>> seam_edges, std::optional<Array<bool>> selected_faces,
                  const std::string& method, const PinList& pins, std::optional<Array<bool>> pinned,
                  std::optional<Array<double>> uv, double soft_pins, const std::optional<Array<double>>& face_metric,
                  const PatchOptions& patch)
      : arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)},
        pinned_corners(std::move(pinned)),
        corner_uv(std::move(uv)) {
    if (face_metric) {
      // A metric (F, 2, 2) comes with triangles only.
      const bool in_space = face_metric->shape(1) == 3;
      metric = space_metric(
          vertices, in_space ? corner_vertices : Array<int>(Array<int>(corner_vertices).reshape({-1, 3})), face_metric);
      options.metric = metric.data();
    }
    options.patch = patch;
    options.solve.method = method_named(method);
    options.solve.soft_pins = soft_pins;
    options.vertex_pins = pins_of(pins);
    if (pinned_corners && corner_uv) options.corner_pins = {pinned_corners->data(), corner_uv->data()};
  }
};

py::dict unwrap_mesh(UnwrapArguments& arguments, const ExtenderList& extenders, double hole_rigidity, double tolerance,
                     const py::object& progress) {
  arguments.options.extenders = extenders_of(extenders);
  arguments.options.solve.hole_rigidity = hole_rigidity;
  arguments.options.solve.tolerance = tolerance;
  const PolygonMesh mesh = arguments.arrays.view();
  const Progress callback = progress_of(progress);
  Unwrap unwrapped;
  {
    const py::gil_scoped_release unlocked;
    unwrapped = unwrap(mesh, arguments.options, callback);
  }
  return result_of(unwrapped);
}

/// An Unwrapper with the arrays of its mesh.
class MeshUnwrapper {
 public:
  explicit MeshUnwrapper(const UnwrapArguments& arguments) : arguments_(arguments) {
    // The copies refer to the same arrays, but to a metric of their own.
    if (arguments_.options.metric != nullptr) arguments_.options.metric = arguments_.metric.data();
    const PolygonMesh mesh = arguments_.arrays.view();
    const py::gil_scoped_release unlocked;
    unwrapper_ = std::make_unique<Unwrapper>(mesh, arguments_.options);
  }

  py::dict solve(const ExtenderList& extenders, double hole_rigidity, double tolerance, const py::object& progress) {
    const Progress callback = progress_of(progress);
    Unwrap unwrapped;
    {
      const Turns::Turn turn(turns_);
      const py::gil_scoped_release unlocked;
      unwrapped = unwrapper_->solve(extenders_of(extenders), hole_rigidity, tolerance, callback);
    }
    return result_of(unwrapped);
  }

 private:
  Turns turns_;
  UnwrapArguments arguments_;
  std::unique_ptr<Unwrapper> unwrapper_;
};

}  // namespace

void bind_unwrap(py::module_& module) {
  py::class_<UnwrapArguments>(module, "UnwrapArguments", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const Array<int>&, std::optional<Array<int>>,
                    std::optional<Array<bool>>, const std::string&, const PinList&, std::optional<Array<bool>>,
                    std::optional<Array<double>>, double, const std::optional<Array<double>>&, const PatchOptions&>());
  py::class_<MeshUnwrapper>(module, "Unwrapper", py::module_local())
      .def(py::init<const UnwrapArguments&>())
      .def("solve", &MeshUnwrapper::solve);
  module.def("unwrap", &unwrap_mesh);
}

}  // namespace spectral_conformal::python
