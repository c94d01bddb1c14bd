// Conversions only: validation and messages are in the Python facade and in the core.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>

#include "spectral_conformal/distortion.h"
#include "spectral_conformal/factorization.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/seam_suggestion.h"
#include "spectral_conformal/unwrap.h"

namespace py = pybind11;
namespace sc = spectral_conformal;

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
using PinList = std::vector<std::tuple<int, double, double>>;

/// A mesh that refers to the arrays it was made from and keeps them alive.
struct MeshArrays {
  Array<double> vertices;
  Array<int> face_offsets;
  Array<int> corner_vertices;
  std::optional<Array<int>> seam_edges;
  std::optional<Array<bool>> selected_faces;

  sc::PolygonMesh view() const {
    sc::PolygonMesh mesh;
    mesh.positions = vertices.data();
    mesh.n_vertices = static_cast<int>(vertices.shape(0));
    mesh.face_offsets = face_offsets.data();
    mesh.n_faces = std::max(0, static_cast<int>(face_offsets.shape(0)) - 1);
    mesh.corner_vertices = corner_vertices.data();
    if (selected_faces) mesh.selected_faces = selected_faces->data();
    if (seam_edges) {
      static_assert(sizeof(std::array<int, 2>) == 2 * sizeof(int));
      mesh.seam_edges = reinterpret_cast<const std::array<int, 2>*>(seam_edges->data());
      mesh.n_seam_edges = static_cast<int>(seam_edges->shape(0));
    }
    return mesh;
  }
};

MeshArrays triangle_mesh(const Array<double>& vertices, const Array<int>& triangles) {
  const auto n = triangles.shape(0);
  Array<int> offsets(n + 1);
  for (py::ssize_t i = 0; i <= n; ++i) offsets.mutable_at(i) = static_cast<int>(3 * i);
  return {vertices, offsets, Array<int>(triangles).reshape({3 * n}), std::nullopt, std::nullopt};
}

template <class T>
T named(const std::string& name, std::initializer_list<std::pair<const char*, T>> choices, const char* what) {
  std::string list;
  for (const auto& [key, value] : choices) {
    if (name == key) return value;
    list += std::string(list.empty() ? "'" : ", '") + key + "'";
  }
  throw py::value_error(std::string(what) + " must be one of " + list + ", not '" + name + "'.");
}

constexpr std::initializer_list<std::pair<const char*, sc::Method>> methods = {{"spectral", sc::Method::spectral},
                                                                               {"lscm", sc::Method::lscm},
                                                                               {"fiedler", sc::Method::fiedler},
                                                                               {"area", sc::Method::area}};

sc::Method method_named(const std::string& name) { return named<sc::Method>(name, methods, "method"); }

const char* name_of(sc::Method method) {
  for (const auto& [name, value] : methods) {
    if (value == method) return name;
  }
  return "";
}

sc::Weights weights_named(const std::string& name) {
  return named<sc::Weights>(name, {{"uniform", sc::Weights::uniform}, {"inverse_area", sc::Weights::inverse_area}},
                            "weights");
}

sc::BoundaryMeasure boundary_named(const std::string& name) {
  return named<sc::BoundaryMeasure>(
      name, {{"length", sc::BoundaryMeasure::length}, {"vertex", sc::BoundaryMeasure::vertex}}, "boundary");
}

sc::FactorizationBackend backend_named(const std::string& name) {
  return named<sc::FactorizationBackend>(name,
                                         {{"auto", sc::FactorizationBackend::automatic},
                                          {"cholmod", sc::FactorizationBackend::cholmod},
                                          {"eigen", sc::FactorizationBackend::eigen}},
                                         "factorization");
}

/// Takes the GIL for the call; None and anything true go on. Python's exceptions pass through, and Ctrl-C is heard even
/// where there is nothing to call.
sc::Progress progress_of(const py::object& callable) {
  return [&callable](double fraction, const char* phase) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callable.is_none()) return true;
    const py::object answer = callable(fraction, phase);
    if (answer.is_none()) return true;
    const int truth = PyObject_IsTrue(answer.ptr());
    if (truth < 0) throw py::error_already_set();
    return truth != 0;
  };
}

sc::Pins pins_of(const PinList& list) {
  sc::Pins pins;
  for (const auto& [vertex, u, v] : list) pins[vertex] = sc::Complex(u, v);
  return pins;
}

py::array_t<double> real_view(const sc::ComplexVector& z) {
  py::array_t<double> result({static_cast<py::ssize_t>(z.size()), static_cast<py::ssize_t>(2)});
  std::copy_n(reinterpret_cast<const double*>(z.data()), 2 * z.size(), result.mutable_data());
  return result;
}

py::array_t<double> copy(const Eigen::VectorXd& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<int> copy(const std::vector<int>& values) {
  return py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<bool> copy(const std::vector<bool>& values) {
  py::array_t<bool> result(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), result.mutable_data());
  return result;
}

/// A Solver on a mesh's one patch, which maps between the mesh's vertices and the chart's.
class PatchSolver {
 public:
  PatchSolver(const Array<double>& vertices, const Array<int>& triangles, const std::string& weights,
              const std::string& boundary, const std::string& backend, bool fill_holes)
      : n_vertices_(vertices.shape(0)) {
    const MeshArrays arrays = triangle_mesh(vertices, triangles);
    const sc::PolygonMesh mesh = arrays.view();
    const auto weights_value = weights_named(weights);
    const auto boundary_value = boundary_named(boundary);
    const auto backend_value = backend_named(backend);
    const py::gil_scoped_release unlocked;
    const auto start = std::chrono::steady_clock::now();
    const sc::Chart chart = sc::single_patch(mesh);
    charts_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    vertices_ = chart.vertices;
    solver_ = std::make_unique<sc::Solver>(chart, chart.positions(mesh), weights_value, boundary_value, backend_value,
                                           fill_holes);
  }

  void factorize(const py::object& progress) {
    const sc::Progress callback = progress_of(progress);
    const Turn turn(*this);
    const py::gil_scoped_release unlocked;
    solver_->factorize(callback);
  }

  py::dict solve(const std::string& method, const PinList& pin_list, double soft_pins, double tolerance,
                 const py::object& progress) {
    const sc::Progress callback = progress_of(progress);
    const auto method_value = method_named(method);
    sc::Pins pins;
    for (const auto& [vertex, position] : pins_of(pin_list)) {
      const auto place = std::lower_bound(vertices_.begin(), vertices_.end(), vertex);
      if (place == vertices_.end() || *place != vertex) {
        throw sc::InvalidMesh("Vertex " + std::to_string(vertex) + " is pinned, but no triangle uses it.");
      }
      pins[static_cast<int>(place - vertices_.begin())] = position;
    }
    sc::Parameterization solution;
    sc::ComplexVector z;
    {
      const Turn turn(*this);
      const py::gil_scoped_release unlocked;
      solution = solver_->solve({method_value, tolerance, soft_pins}, pins, callback);
      z = sc::ComplexVector::Zero(n_vertices_);
      for (std::size_t v = 0; v < vertices_.size(); ++v) z[vertices_[v]] = solution.z[static_cast<Eigen::Index>(v)];
    }
    py::dict timings;
    timings["charts"] = charts_seconds_;
    for (const auto& [phase, seconds] : solution.timings) timings[phase.c_str()] = seconds;
    py::dict result;
    result["uv"] = real_view(z);
    result["eigenvalue"] = solution.eigenvalue;
    result["residual"] = solution.residual;
    result["iterations"] = solution.iterations;
    result["turning_number"] = solution.turning_number;
    result["message"] = solution.message;
    result["timings"] = timings;
    return result;
  }

 private:
  /// The factor has work space of its own, so threads take turns. Waits without the GIL; the thread whose turn it is
  /// must not come again (from its progress function).
  class Turn {
   public:
    explicit Turn(PatchSolver& solver) : solver_(solver) {
      if (solver.owner_ == std::this_thread::get_id()) {
        throw std::runtime_error("This Solver is solving already; its progress function must not call it again.");
      }
      {
        const py::gil_scoped_release unlocked;
        solver.mutex_.lock();
      }
      solver.owner_ = std::this_thread::get_id();
    }
    ~Turn() {
      solver_.owner_ = std::thread::id();
      solver_.mutex_.unlock();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    PatchSolver& solver_;
  };

  std::mutex mutex_;
  std::atomic<std::thread::id> owner_{};
  Eigen::Index n_vertices_;
  double charts_seconds_ = 0;
  std::vector<int> vertices_;
  std::unique_ptr<sc::Solver> solver_;
};

py::dict distortion(const Array<double>& vertices, const Array<int>& triangles, const Array<double>& uv) {
  const MeshArrays arrays = triangle_mesh(vertices, triangles);
  const sc::PolygonMesh mesh = arrays.view();
  sc::Distortion measured;
  {
    const py::gil_scoped_release unlocked;
    const sc::ComplexVector z =
        Eigen::Map<const sc::ComplexVector>(reinterpret_cast<const sc::Complex*>(uv.data()), uv.shape(0));
    measured = sc::measure_mesh_distortion(mesh, z);
  }
  py::dict result;
  result["qc"] = copy(measured.qc);
  result["mean_qc"] = measured.mean_qc;
  result["p95_qc"] = measured.p95_qc;
  result["p99_qc"] = measured.p99_qc;
  result["max_qc"] = measured.max_qc;
  result["log2_scale"] = copy(measured.log2_scale);
  result["log2_scale_deviation"] = measured.log2_scale_deviation;
  result["flipped"] = copy(measured.flipped);
  result["turning_number"] = measured.turning_number;
  result["overlapping"] = copy(measured.overlapping);
  return result;
}

py::dict unwrap(const Array<double>& vertices, const Array<int>& face_offsets, const Array<int>& corner_vertices,
                std::optional<Array<int>> seam_edges, std::optional<Array<bool>> selected_faces,
                const std::string& method, const std::string& weights, const std::string& boundary,
                const PinList& pin_list, const std::optional<Array<bool>>& pinned_corners,
                const std::optional<Array<double>>& corner_uv, double soft_pins, bool fill_holes, double tolerance,
                const std::string& backend, const py::object& progress) {
  const MeshArrays arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)};
  const sc::PolygonMesh mesh = arrays.view();
  const sc::ParameterizeOptions options{
      method_named(method),  weights_named(weights), boundary_named(boundary), tolerance, fill_holes, soft_pins,
      backend_named(backend)};
  sc::CornerPins corner_pins;
  if (pinned_corners && corner_uv) corner_pins = {pinned_corners->data(), corner_uv->data()};
  const sc::Progress callback = progress_of(progress);
  sc::Unwrap unwrapped;
  {
    const py::gil_scoped_release unlocked;
    unwrapped = sc::unwrap(mesh, options, pins_of(pin_list), corner_pins, callback);
  }
  py::array_t<double> uv({static_cast<py::ssize_t>(unwrapped.uv.rows()), static_cast<py::ssize_t>(2)});
  std::copy_n(unwrapped.uv.data(), unwrapped.uv.size(), uv.mutable_data());
  py::list charts;
  for (const sc::UnwrappedChart& chart : unwrapped.charts) {
    charts.append(py::dict(py::arg("faces") = copy(chart.faces), py::arg("status") = chart.solved ? "solved" : "failed",
                           py::arg("message") = chart.message, py::arg("eigenvalue") = chart.eigenvalue,
                           py::arg("residual") = chart.residual, py::arg("iterations") = chart.iterations,
                           py::arg("turning_number") = chart.turning_number, py::arg("mean_qc") = chart.mean_qc,
                           py::arg("max_qc") = chart.max_qc, py::arg("flipped") = chart.flipped,
                           py::arg("method") = name_of(chart.method), py::arg("n_pins") = chart.n_pins,
                           py::arg("n_vertices") = chart.n_vertices, py::arg("area") = chart.area));
  }
  return py::dict(py::arg("uv") = uv, py::arg("solved_corners") = copy(unwrapped.solved_corners),
                  py::arg("chart_of_face") = copy(unwrapped.chart_of_face), py::arg("charts") = charts);
}

py::array_t<int> suggest_seams(const Array<double>& vertices, const Array<int>& face_offsets,
                               const Array<int>& corner_vertices, std::optional<Array<int>> seam_edges,
                               std::optional<Array<bool>> selected_faces, double max_length, double scale_limit,
                               double qc_limit, const std::string& weights, const std::string& boundary,
                               const std::string& backend, const py::object& progress) {
  const MeshArrays arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)};
  const sc::PolygonMesh mesh = arrays.view();
  sc::SeamSuggestionOptions options;
  options.max_length = max_length;
  options.scale_limit = scale_limit;
  options.qc_limit = qc_limit;
  options.map.weights = weights_named(weights);
  options.map.boundary = boundary_named(boundary);
  options.map.backend = backend_named(backend);
  const sc::Progress callback = progress_of(progress);
  sc::SeamSuggestion suggestion;
  {
    const py::gil_scoped_release unlocked;
    suggestion = sc::suggest_seams(mesh, options, callback);
  }
  py::array_t<int> edges({static_cast<py::ssize_t>(suggestion.edges.size()), static_cast<py::ssize_t>(2)});
  if (!suggestion.edges.empty()) {
    std::copy_n(suggestion.edges.front().data(), 2 * suggestion.edges.size(), edges.mutable_data());
  }
  return edges;
}

py::dict build_info() {
  return py::dict(py::arg("factorization") = sc::factorization_library(), py::arg("blas") = sc::blas_library());
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  // Local to this module: a bundled copy and an installed one may be loaded side by side.
  py::register_local_exception<sc::InvalidMesh>(module, "InvalidMeshError", PyExc_ValueError);
  py::register_local_exception<sc::SolveFailure>(module, "SolveError", PyExc_RuntimeError);
  py::register_local_exception<sc::Cancelled>(module, "Cancelled", PyExc_Exception);
  py::class_<PatchSolver>(module, "Solver", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const std::string&, const std::string&, const std::string&,
                    bool>())
      .def("factorize", &PatchSolver::factorize)
      .def("solve", &PatchSolver::solve);
  module.def("distortion", &distortion);
  module.def("unwrap", &unwrap);
  module.def("suggest_seams", &suggest_seams);
  module.def("build_info", &build_info);
}
