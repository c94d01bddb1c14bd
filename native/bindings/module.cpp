// Conversions only: validation and messages are in the Python facade and in the core.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>

#include "linear_algebra/blas_threads.h"
#include "linear_algebra/factorization.h"
#include "mesh/chart_checks.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/map_defects.h"
#include "spectral_conformal/metric.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/seam_suggestion.h"
#include "spectral_conformal/unwrap.h"

namespace py = pybind11;
namespace sc = spectral_conformal;

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
using PinList = std::vector<std::tuple<int, double, double>>;
using ExtenderList = std::vector<std::tuple<int, int, double>>;

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

sc::PatchOptions patch_options(const std::string& weights, const std::string& boundary, const std::string& backend,
                               bool fill_holes, double area_blend, bool fold_free) {
  return {weights_named(weights), boundary_named(boundary), backend_named(backend), fill_holes, area_blend, fold_free};
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

std::vector<sc::VertexExtender> extenders_of(const ExtenderList& list) {
  std::vector<sc::VertexExtender> extenders;
  for (const auto& [from, to, strength] : list) extenders.push_back({from, to, strength});
  return extenders;
}

/// Corner k of triangle t.
Eigen::Vector3d corner(const Array<double>& vertices, const Array<int>& triangles, py::ssize_t t, int k) {
  return Eigen::Map<const Eigen::Vector3d>(vertices.data(triangles.at(t, k), 0));
}

Eigen::Matrix<double, 2, 3> frame_of(const Array<double>& vertices, const Array<int>& triangles, py::ssize_t t) {
  return sc::tangent_frame(corner(vertices, triangles, t, 0), corner(vertices, triangles, t, 1),
                           corner(vertices, triangles, t, 2));
}

/// Tensors of space from a metric (F, 2, 2) in the frames of the triangles' first sides, or (n, 3, 3) as it is.
std::vector<sc::SpaceMetric> space_metric(const Array<double>& vertices, const Array<int>& triangles,
                                          const std::optional<Array<double>>& metric) {
  std::vector<sc::SpaceMetric> result;
  if (!metric) return result;
  result.reserve(static_cast<std::size_t>(metric->shape(0)));
  for (py::ssize_t t = 0; t < metric->shape(0); ++t) {
    if (metric->shape(1) == 3) {
      result.emplace_back(Eigen::Map<const Eigen::Matrix3d>(metric->data(t, 0, 0)));
    } else {
      const auto frame = frame_of(vertices, triangles, t);
      result.emplace_back(frame.transpose() * Eigen::Map<const Eigen::Matrix2d>(metric->data(t, 0, 0)) * frame);
    }
  }
  return result;
}

void set_metric(Array<double>& metric, py::ssize_t t, const sc::TriangleMetric& g) {
  metric.mutable_at(t, 0, 0) = g.xx;
  metric.mutable_at(t, 0, 1) = metric.mutable_at(t, 1, 0) = g.xy;
  metric.mutable_at(t, 1, 1) = g.yy;
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

/// A factor has work space of its own, so threads take turns. Waits without the GIL; the thread whose turn it is must
/// not come again (from its progress function).
class Turns {
 public:
  class Turn {
   public:
    explicit Turn(Turns& turns) : turns_(turns) {
      if (turns.owner_ == std::this_thread::get_id()) {
        throw std::runtime_error("This solver is solving already; its progress function must not call it again.");
      }
      {
        const py::gil_scoped_release unlocked;
        turns.mutex_.lock();
      }
      turns.owner_ = std::this_thread::get_id();
    }
    ~Turn() {
      turns_.owner_ = std::thread::id();
      turns_.mutex_.unlock();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Turns& turns_;
  };

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> owner_{};
};

/// A Solver on a mesh's one patch, which maps between the mesh's vertices and the chart's.
class PatchSolver {
 public:
  PatchSolver(const Array<double>& vertices, const Array<int>& triangles, const std::optional<Array<double>>& metric,
              const sc::PatchOptions& options)
      : n_vertices_(vertices.shape(0)) {
    const MeshArrays arrays = triangle_mesh(vertices, triangles);
    const sc::PolygonMesh mesh = arrays.view();
    const std::vector<sc::SpaceMetric> tensors = space_metric(vertices, triangles, metric);
    const py::gil_scoped_release unlocked;
    const auto start = std::chrono::steady_clock::now();
    const sc::Chart chart = sc::single_patch(mesh);
    charts_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    vertices_ = chart.vertices;
    solver_ = std::make_unique<sc::Solver>(chart, chart.positions(mesh), options,
                                           sc::chart_metric(mesh, chart, tensors.empty() ? nullptr : tensors.data()));
  }

  void factorize(const py::object& progress) {
    const sc::Progress callback = progress_of(progress);
    const Turns::Turn turn(turns_);
    const py::gil_scoped_release unlocked;
    solver_->factorize(callback);
  }

  py::dict solve(const std::string& method, const PinList& pin_list, double soft_pins, const ExtenderList& extenders,
                 double hole_rigidity, double tolerance, const py::object& progress) {
    const sc::Progress callback = progress_of(progress);
    sc::SolveOptions options;
    options.method = method_named(method);
    options.tolerance = tolerance;
    options.soft_pins = soft_pins;
    options.hole_rigidity = hole_rigidity;
    for (const auto& [from, to, strength] : extenders) {
      options.extenders.push_back(
          {{chart_vertex(from, "has an extender")}, {chart_vertex(to, "has an extender")}, strength});
    }
    sc::Pins pins;
    for (const auto& [vertex, position] : pins_of(pin_list)) pins[chart_vertex(vertex, "is pinned")] = position;
    sc::Parameterization solution;
    sc::ComplexVector z;
    {
      const Turns::Turn turn(turns_);
      const py::gil_scoped_release unlocked;
      solution = solver_->solve(options, pins, callback);
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
    result["unfolded"] = solution.unfolded;
    result["is_embedding"] = solution.is_embedding;
    result["mean_qc_before"] = solution.mean_qc_before;
    result["message"] = solution.message;
    result["timings"] = timings;
    return result;
  }

 private:
  int chart_vertex(int vertex, const char* role) const {
    const auto place = std::lower_bound(vertices_.begin(), vertices_.end(), vertex);
    if (place == vertices_.end() || *place != vertex) {
      throw sc::InvalidMesh("Vertex " + std::to_string(vertex) + " " + role + ", but no triangle uses it.");
    }
    return static_cast<int>(place - vertices_.begin());
  }

  Turns turns_;
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

py::dict map_defects(const Array<int>& face_offsets, const Array<int>& corner_vertices, const Array<double>& corner_uv,
                     const std::optional<Array<bool>>& selected_faces, bool between_islands) {
  sc::PolygonMesh mesh;
  // Positions are not looked at; as many as the corners need.
  const auto n_corners = static_cast<std::ptrdiff_t>(corner_vertices.size());
  const int* const last = std::max_element(corner_vertices.data(), corner_vertices.data() + n_corners);
  mesh.n_vertices = n_corners == 0 ? 0 : std::min(*last, std::numeric_limits<int>::max() - 1) + 1;
  mesh.face_offsets = face_offsets.data();
  mesh.n_faces = static_cast<int>(face_offsets.shape(0)) - 1;
  mesh.corner_vertices = corner_vertices.data();
  if (selected_faces) mesh.selected_faces = selected_faces->data();
  sc::MapDefects defects;
  {
    const py::gil_scoped_release unlocked;
    defects = sc::find_map_defects(mesh, corner_uv.data(), between_islands);
  }
  return py::dict(py::arg("flipped") = copy(defects.flipped), py::arg("overlapping") = copy(defects.overlapping));
}

py::dict result_of(const sc::Unwrap& unwrapped) {
  py::array_t<double> uv({static_cast<py::ssize_t>(unwrapped.uv.rows()), static_cast<py::ssize_t>(2)});
  std::copy_n(unwrapped.uv.data(), unwrapped.uv.size(), uv.mutable_data());
  py::list charts;
  for (const sc::UnwrappedChart& chart : unwrapped.charts) {
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
  std::vector<sc::SpaceMetric> metric;
  sc::UnwrapOptions options;

  UnwrapArguments(const Array<double>& vertices, const Array<int>& face_offsets, const Array<int>& corner_vertices,
                  std::optional<Array<int>> seam_edges, std::optional<Array<bool>> selected_faces,
                  const std::string& method, const PinList& pins, std::optional<Array<bool>> pinned,
                  std::optional<Array<double>> uv, double soft_pins, const std::optional<Array<double>>& face_metric,
                  const sc::PatchOptions& patch)
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

py::dict unwrap(UnwrapArguments& arguments, const ExtenderList& extenders, double hole_rigidity, double tolerance,
                const py::object& progress) {
  arguments.options.extenders = extenders_of(extenders);
  arguments.options.solve.hole_rigidity = hole_rigidity;
  arguments.options.solve.tolerance = tolerance;
  const sc::PolygonMesh mesh = arguments.arrays.view();
  const sc::Progress callback = progress_of(progress);
  sc::Unwrap unwrapped;
  {
    const py::gil_scoped_release unlocked;
    unwrapped = sc::unwrap(mesh, arguments.options, callback);
  }
  return result_of(unwrapped);
}

/// An Unwrapper with the arrays of its mesh.
class MeshUnwrapper {
 public:
  explicit MeshUnwrapper(const UnwrapArguments& arguments) : arguments_(arguments) {
    // The copies refer to the same arrays, but to a metric of their own.
    if (arguments_.options.metric != nullptr) arguments_.options.metric = arguments_.metric.data();
    const sc::PolygonMesh mesh = arguments_.arrays.view();
    const py::gil_scoped_release unlocked;
    unwrapper_ = std::make_unique<sc::Unwrapper>(mesh, arguments_.options);
  }

  py::dict solve(const ExtenderList& extenders, double hole_rigidity, double tolerance, const py::object& progress) {
    const sc::Progress callback = progress_of(progress);
    sc::Unwrap unwrapped;
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
  std::unique_ptr<sc::Unwrapper> unwrapper_;
};

py::array_t<double> metric_from_uv(const Array<double>& vertices, const Array<int>& triangles,
                                   const Array<double>& uv) {
  const py::ssize_t n = triangles.shape(0);
  Array<double> metric({n, py::ssize_t{2}, py::ssize_t{2}});
  for (py::ssize_t t = 0; t < n; ++t) {
    const auto image = [&](int k) {
      const int v = triangles.at(t, k);
      return sc::Complex(uv.at(v, 0), uv.at(v, 1));
    };
    const sc::TriangleShape shape = sc::lay_out(corner(vertices, triangles, t, 0), corner(vertices, triangles, t, 1),
                                                corner(vertices, triangles, t, 2));
    set_metric(
        metric, t,
        shape.clamped ? sc::TriangleMetric{} : sc::metric_of_map(shape, image(1) - image(0), image(2) - image(0)));
  }
  return metric;
}

py::array_t<double> metric_from_direction(const Array<double>& vertices, const Array<int>& triangles,
                                          const Array<double>& directions, const Array<double>& ratios) {
  const py::ssize_t n = triangles.shape(0);
  Array<double> metric({n, py::ssize_t{2}, py::ssize_t{2}});
  for (py::ssize_t t = 0; t < n; ++t) {
    const Eigen::Map<const Eigen::Vector3d> direction(directions.data(t, 0));
    set_metric(metric, t, sc::metric_along(direction, ratios.at(t), frame_of(vertices, triangles, t)));
  }
  return metric;
}

sc::TriangleMetric metric_at(const Array<double>& metric, py::ssize_t t) {
  return {metric.at(t, 0, 0), metric.at(t, 0, 1), metric.at(t, 1, 1)};
}

py::array_t<double> blend_metric(const Array<double>& metric, double amount) {
  Array<double> result({metric.shape(0), py::ssize_t{2}, py::ssize_t{2}});
  for (py::ssize_t t = 0; t < metric.shape(0); ++t) set_metric(result, t, sc::blend(metric_at(metric, t), amount));
  return result;
}

/// The first metric that is not positive definite, or -1.
py::ssize_t first_not_positive_definite(const Array<double>& metric) {
  for (py::ssize_t t = 0; t < metric.shape(0); ++t) {
    if (!sc::is_positive_definite(metric_at(metric, t))) return t;
  }
  return -1;
}

/// Returns the edges and where each cut begins in them.
py::tuple suggest_seams(const Array<double>& vertices, const Array<int>& face_offsets,
                        const Array<int>& corner_vertices, std::optional<Array<int>> seam_edges,
                        std::optional<Array<bool>> selected_faces, double max_length, double scale_limit,
                        double qc_limit, const sc::PatchOptions& patch, const py::object& progress) {
  const MeshArrays arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)};
  const sc::PolygonMesh mesh = arrays.view();
  sc::SeamSuggestionOptions options;
  options.max_length = max_length;
  options.scale_limit = scale_limit;
  options.qc_limit = qc_limit;
  options.map = patch;
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
  return py::make_tuple(edges, copy(suggestion.cut_offsets));
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
  py::class_<sc::PatchOptions>(module, "PatchOptions", py::module_local()).def(py::init(&patch_options));
  py::class_<PatchSolver>(module, "Solver", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const std::optional<Array<double>>&,
                    const sc::PatchOptions&>())
      .def("factorize", &PatchSolver::factorize)
      .def("solve", &PatchSolver::solve);
  py::class_<UnwrapArguments>(module, "UnwrapArguments", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const Array<int>&, std::optional<Array<int>>,
                    std::optional<Array<bool>>, const std::string&, const PinList&, std::optional<Array<bool>>,
                    std::optional<Array<double>>, double, const std::optional<Array<double>>&,
                    const sc::PatchOptions&>());
  py::class_<MeshUnwrapper>(module, "Unwrapper", py::module_local())
      .def(py::init<const UnwrapArguments&>())
      .def("solve", &MeshUnwrapper::solve);
  module.def("distortion", &distortion);
  module.def("map_defects", &map_defects);
  module.def("unwrap", &unwrap);
  module.def("metric_from_uv", &metric_from_uv);
  module.def("metric_from_direction", &metric_from_direction);
  module.def("blend_metric", &blend_metric);
  module.def("first_not_positive_definite", &first_not_positive_definite);
  module.def("suggest_seams", &suggest_seams);
  module.def("build_info", &build_info);
  module.attr("SIZE_LIMIT") = sc::size_limit;
}
