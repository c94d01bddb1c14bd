#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/options.h"
#include "bindings/progress_function.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal::python {

namespace {

/// Returns the edges, the offset of each cut in them, and the two counts of parts given up for lack of memory.
py::tuple suggest(const Array<double>& vertices, const Array<int>& face_offsets, const Array<int>& corner_vertices,
                  std::optional<Array<int>> seam_edges, std::optional<Array<bool>> selected_faces,
                  std::optional<Array<double>> vertex_preference, std::optional<Array<int>> avoided_edges,
                  std::optional<Array<int>> preferred_edges, std::optional<Array<double>> edge_preference,
                  const py::object& given_options, const py::object& progress) {
  const MeshArrays arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)};
  const PolygonMesh mesh = arrays.view();
  SeamSuggestionOptions options = seam_options_of(given_options);
  if (vertex_preference) options.vertex_preference = vertex_preference->data();
  if (avoided_edges) {
    options.avoided_edges = reinterpret_cast<const std::array<int, 2>*>(avoided_edges->data());
    options.n_avoided_edges = static_cast<int>(avoided_edges->shape(0));
  }
  if (preferred_edges) {
    options.preferred_edges = reinterpret_cast<const std::array<int, 2>*>(preferred_edges->data());
    options.n_preferred_edges = static_cast<int>(preferred_edges->shape(0));
  }
  if (edge_preference) options.edge_preference = edge_preference->data();
  const Progress callback = progress_of(progress);
  SeamSuggestion suggestion;
  {
    const py::gil_scoped_release unlocked;
    suggestion = suggest_seams(mesh, options, callback);
  }
  py::array_t<int> edges({static_cast<py::ssize_t>(suggestion.edges.size()), static_cast<py::ssize_t>(2)});
  if (!suggestion.edges.empty()) {
    std::copy_n(suggestion.edges.front().data(), 2 * suggestion.edges.size(), edges.mutable_data());
  }
  return py::make_tuple(edges, copy(suggestion.cut_offsets), suggestion.n_given_up, suggestion.given_up_vertices);
}

/// Issues a RuntimeWarning at the caller of the public function, skipping that function and its option check.
void warn(const std::string& message) {
  if (PyErr_WarnEx(PyExc_RuntimeWarning, message.c_str(), 3) != 0) throw py::error_already_set();
}

}  // namespace

void bind_seams(py::module_& module) {
  module.def("suggest_seams", &suggest);
  module.def("energy_at", &energy_at);
  module.def("warn", &warn);
}

}  // namespace spectral_conformal::python
