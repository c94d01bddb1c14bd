#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/map_defects.h"

namespace spectral_conformal::python {

namespace {

py::dict distortion(const Array<double>& vertices, const Array<int>& triangles, const Array<double>& uv) {
  const MeshArrays arrays = triangle_mesh(vertices, triangles);
  const PolygonMesh mesh = arrays.view();
  Distortion measured;
  {
    const py::gil_scoped_release unlocked;
    const ComplexVector z = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(uv.data()), uv.shape(0));
    measured = measure_mesh_distortion(mesh, z);
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
  PolygonMesh mesh;
  // Positions are not looked at; as many as the corners need.
  const auto n_corners = static_cast<std::ptrdiff_t>(corner_vertices.size());
  const int* const last = std::max_element(corner_vertices.data(), corner_vertices.data() + n_corners);
  mesh.n_vertices = n_corners == 0 ? 0 : std::min(*last, std::numeric_limits<int>::max() - 1) + 1;
  mesh.face_offsets = face_offsets.data();
  mesh.n_faces = static_cast<int>(face_offsets.shape(0)) - 1;
  mesh.corner_vertices = corner_vertices.data();
  if (selected_faces) mesh.selected_faces = selected_faces->data();
  MapDefects defects;
  {
    const py::gil_scoped_release unlocked;
    defects = find_map_defects(mesh, corner_uv.data(), between_islands);
  }
  return py::dict(py::arg("flipped") = copy(defects.flipped), py::arg("overlapping") = copy(defects.overlapping));
}

}  // namespace

void bind_quality(py::module_& module) {
  module.def("distortion", &distortion);
  module.def("map_defects", &map_defects);
}

}  // namespace spectral_conformal::python
