#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/progress_function.h"
#include "mesh/charts.h"
#include "mesh/connected_faces.h"

namespace spectral_conformal::python {

namespace {

py::array_t<int> chart_of_face(const Array<double>& vertices, const Array<int>& face_offsets,
                               const Array<int>& corner_vertices, std::optional<Array<int>> seam_edges,
                               std::optional<Array<bool>> selected_faces) {
  const MeshArrays arrays{vertices, face_offsets, corner_vertices, std::move(seam_edges), std::move(selected_faces)};
  const PolygonMesh mesh = arrays.view();
  std::vector<int> charts;
  {
    const PolledWork polling("charts");
    charts = build_charts(mesh).chart_of_face;
  }
  return copy(charts);
}

py::array_t<int> connected_faces_of(const Array<int>& face_offsets, const Array<int>& corner_vertices, int n_vertices) {
  std::vector<int> components;
  {
    const PolledWork polling("charts");
    components = connected_faces(face_offsets.data(), corner_vertices.data(), static_cast<int>(face_offsets.size()) - 1,
                                 n_vertices);
  }
  return copy(components);
}

}  // namespace

void bind_charts(py::module_& module) {
  module.def("chart_of_face", &chart_of_face);
  module.def("connected_faces", &connected_faces_of);
}

}  // namespace spectral_conformal::python
