#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/chart_records.h"
#include "bindings/options.h"
#include "bindings/progress_function.h"
#include "bindings/space_metric.h"
#include "bindings/turns.h"
#include "spectral_conformal/kept_maps.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

namespace {

py::dict result_of(Unwrap&& unwrapped) {
  py::array_t<double> uv({static_cast<py::ssize_t>(unwrapped.uv.rows()), static_cast<py::ssize_t>(2)});
  std::copy_n(unwrapped.uv.data(), unwrapped.uv.size(), uv.mutable_data());
  py::dict timings;
  for (const auto& [phase, seconds] : unwrapped.timings) timings[phase.c_str()] = seconds;
  return py::dict(py::arg("timings") = timings, py::arg("uv") = uv,
                  py::arg("solved_corners") = copy(unwrapped.solved_corners),
                  py::arg("chart_of_face") = copy(unwrapped.chart_of_face),
                  py::arg("vertex_of_corner") = copy(unwrapped.vertex_of_corner),
                  py::arg("unused_extenders") = copy(unwrapped.unused_extenders),
                  py::arg("charts") = chart_records(std::move(unwrapped.charts)));
}

/// A mesh to unwrap with its pins, metric and options, and the arrays to which they refer.
struct UnwrapArguments {
  MeshArrays arrays;
  std::optional<Array<bool>> pinned_corners;
  std::optional<Array<double>> corner_uv;
  std::vector<SpaceMetric> metric;
  UnwrapOptions options;

  UnwrapArguments(const Array<double>& vertices, const Array<int>& face_offsets, const Array<int>& corner_vertices,
                  std::optional<Array<int>> seam_edges, std::optional<Array<bool>> selected_faces, const PinList& pins,
                  std::optional<Array<bool>> pinned, std::optional<Array<double>> uv,
                  const std::optional<Array<double>>& face_metric, std::optional<EquationArrays> constraints,
                  const py::object& given_options)
      : arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)},
        pinned_corners(std::move(pinned)),
        corner_uv(std::move(uv)) {
    if (face_metric) {
      // A metric (F, 2, 2) requires triangles.
      const bool in_space = face_metric->shape(1) == 3;
      metric = space_metric(
          vertices, in_space ? corner_vertices : Array<int>(Array<int>(corner_vertices).reshape({-1, 3})), face_metric);
      options.metric = metric.data();
    }
    options.patch = patch_options_of(given_options);
    options.solve = solve_options_of(given_options);
    options.constraints = equations_of(std::move(constraints));
    options.vertex_pins = pins_of(pins);
    if (pinned_corners && corner_uv) options.corner_pins = {pinned_corners->data(), corner_uv->data()};
  }
  // `options` points into the other members.
  UnwrapArguments(const UnwrapArguments&) = delete;
  UnwrapArguments& operator=(const UnwrapArguments&) = delete;
};

/// Kept maps for one unwrap at a time; concurrent unwraps do without. Never waits, since a progress function may call
/// it. The GIL guards its pointer.
class SharedKeptMaps {
  struct Store {
    std::mutex mutex;
    KeptMaps maps;
    std::atomic<std::size_t> size{0};
    explicit Store(std::size_t max_bytes) : maps(max_bytes) {}
  };

 public:
  explicit SharedKeptMaps(std::size_t max_bytes) : max_bytes_(max_bytes) { clear(); }

  /// Holds the maps while it lives, if they are free; constructed with the GIL held.
  class Hold {
   public:
    explicit Hold(const SharedKeptMaps* shared) {
      if (!shared) return;
      store_ = shared->store_;
      lock_ = std::unique_lock(store_->mutex, std::try_to_lock);
    }
    ~Hold() {
      if (lock_) store_->size = store_->maps.size();
    }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;
    KeptMaps* maps() const { return lock_ ? &store_->maps : nullptr; }

   private:
    std::shared_ptr<Store> store_;
    std::unique_lock<std::mutex> lock_;  // after what it locks, so that it is destroyed first
  };

  /// A running call keeps using the old maps.
  void clear() { store_ = std::make_shared<Store>(max_bytes_); }
  /// As of the end of the last completed call.
  std::size_t size() const { return store_->size; }

 private:
  std::size_t max_bytes_;
  std::shared_ptr<Store> store_;
};

py::dict unwrap_mesh(UnwrapArguments& arguments, const ExtenderList& extenders, const py::object& progress,
                     SharedKeptMaps* kept) {
  arguments.options.extenders = extenders_of(extenders);
  const PolygonMesh mesh = arguments.arrays.view();
  const Progress callback = progress_of(progress);
  Unwrap unwrapped;
  {
    const SharedKeptMaps::Hold hold(kept);
    const py::gil_scoped_release unlocked;
    unwrapped = unwrap(mesh, arguments.options, callback, hold.maps());
  }
  return result_of(std::move(unwrapped));
}

/// An Unwrapper; the arguments must outlive it.
class MeshUnwrapper {
 public:
  explicit MeshUnwrapper(const UnwrapArguments& arguments) {
    const PolygonMesh mesh = arguments.arrays.view();
    const PolledWork polling("charts");
    unwrapper_.emplace(Unwrapper::of(mesh, arguments.options));
  }

  py::dict solve(const py::object& given_options, const ExtenderList& extenders,
                 const std::optional<Array<double>>& corner_uv, bool measures, const py::object& progress) {
    const Progress callback = progress_of(progress);
    const SolveOptions options = solve_options_of(given_options);
    Unwrap unwrapped;
    {
      const Turns::Turn turn(turns_);
      const py::gil_scoped_release unlocked;
      unwrapped = unwrapper_->solve(extenders_of(extenders), options.hole_rigidity, options.tolerance,
                                    corner_uv ? corner_uv->data() : nullptr, callback, measures);
    }
    return result_of(std::move(unwrapped));
  }

 private:
  Turns turns_;
  std::optional<Unwrapper> unwrapper_;
};

}  // namespace

void bind_unwrap(py::module_& module) {
  bind_chart_records(module);
  py::class_<UnwrapArguments>(module, "UnwrapArguments", py::module_local())
      .def(
          py::init<const Array<double>&, const Array<int>&, const Array<int>&, std::optional<Array<int>>,
                   std::optional<Array<bool>>, const PinList&, std::optional<Array<bool>>, std::optional<Array<double>>,
                   const std::optional<Array<double>>&, std::optional<EquationArrays>, const py::object&>());
  py::class_<MeshUnwrapper>(module, "Unwrapper", py::module_local())
      .def(py::init<const UnwrapArguments&>(), py::keep_alive<1, 2>())
      .def("solve", &MeshUnwrapper::solve);
  py::class_<SharedKeptMaps>(module, "KeptMaps", py::module_local())
      .def(py::init<std::size_t>())
      .def("clear", &SharedKeptMaps::clear)
      .def("size", &SharedKeptMaps::size);
  module.def("unwrap", &unwrap_mesh);
}

}  // namespace spectral_conformal::python
