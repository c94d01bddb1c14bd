#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/progress_function.h"
#include "concurrency/cancellation_scope.h"
#include "geometry/bounding_rectangles.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/face_distortion.h"
#include "spectral_conformal/face_triangles.h"
#include "spectral_conformal/map_defects.h"

namespace spectral_conformal::python {

namespace {

py::dict distortion(const Array<double>& vertices, const Array<int>& triangles, const Array<double>& uv) {
  const MeshArrays arrays = triangle_mesh(vertices, triangles);
  const PolygonMesh mesh = arrays.view();
  Distortion measured;
  double p95 = 1;
  double p99 = 1;
  {
    const PolledWork polling("quality");
    const ComplexVector z = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(uv.data()), uv.shape(0));
    measured = measure_mesh_distortion(mesh, z);
    p95 = measured.qc_percentile(0.95);
    p99 = measured.qc_percentile(0.99);
  }
  py::dict result;
  result["qc"] = copy(measured.qc);
  result["mean_qc"] = measured.mean_qc;
  result["p95_qc"] = p95;
  result["p99_qc"] = p99;
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
  // Positions are not read; provide as many as the corners need.
  const auto n_corners = static_cast<std::ptrdiff_t>(corner_vertices.size());
  const int* const last = std::max_element(corner_vertices.data(), corner_vertices.data() + n_corners);
  mesh.n_vertices = n_corners == 0 ? 0 : std::min(*last, std::numeric_limits<int>::max() - 1) + 1;
  mesh.face_offsets = face_offsets.data();
  mesh.n_faces = static_cast<int>(face_offsets.shape(0)) - 1;
  mesh.corner_vertices = corner_vertices.data();
  if (selected_faces) mesh.selected_faces = selected_faces->data();
  MapDefects defects;
  {
    const PolledWork polling("quality");
    defects = find_map_defects(mesh, corner_uv.data(), between_islands);
  }
  return py::dict(py::arg("island_of_face") = copy(defects.island_of_face), py::arg("flipped") = copy(defects.flipped),
                  py::arg("overlapping") = copy(defects.overlapping));
}

MeshArrays polygon_mesh(const Array<double>& vertices, const Array<int>& face_offsets,
                        const Array<int>& corner_vertices, const std::optional<Array<bool>>& selected_faces) {
  return {vertices, face_offsets, corner_vertices, std::nullopt, selected_faces};
}

/// Real is the type of the UVs: Blender's are read without conversion.
template <class Real>
py::dict face_distortion(const Array<double>& vertices, const Array<int>& face_offsets,
                         const Array<int>& corner_vertices, const Array<Real>& corner_uv,
                         const std::optional<Array<bool>>& selected_faces) {
  const MeshArrays arrays = polygon_mesh(vertices, face_offsets, corner_vertices, selected_faces);
  FaceDistortion measured;
  {
    const PolygonMesh mesh = arrays.view();
    const PolledWork polling("quality");
    measured = measure_face_distortion(mesh, corner_uv.data());
  }
  return py::dict(
      py::arg("qc") = moved(std::move(measured.qc)), py::arg("log2_scale") = moved(std::move(measured.log2_scale)),
      py::arg("area") = moved(std::move(measured.area)), py::arg("image_area") = moved(std::move(measured.image_area)));
}

/// points: (n, 2) of groups one after the other, of which each begins at its offset, (groups + 1,). Returns the area of
/// the smallest rectangle of any direction around each group, (groups,).
py::array_t<double> rectangle_areas(const Array<double>& points, const Array<int>& offsets) {
  py::array_t<double> areas(offsets.shape(0) - 1);
  double* const area = areas.mutable_data();
  const auto* const first = reinterpret_cast<const Complex*>(points.data());
  const PolledWork polling("quality");
  for_each_polled(offsets.shape(0) - 1, [&](py::ssize_t group) {
    const int begin = offsets.data()[group];
    const int end = offsets.data()[group + 1];
    area[group] = 0;
    if (begin == end) return;
    const Rectangle smallest = smallest_rectangles(convex_hull({first + begin, first + end}), 0).front();
    area[group] = smallest.width * smallest.height;
  });
  return areas;
}

py::tuple face_triangles(const Array<double>& vertices, const Array<int>& face_offsets,
                         const Array<int>& corner_vertices, const std::optional<Array<bool>>& selected_faces) {
  const MeshArrays arrays = polygon_mesh(vertices, face_offsets, corner_vertices, selected_faces);
  FaceTriangles triangles;
  {
    const PolygonMesh mesh = arrays.view();
    const PolledWork polling("quality");
    triangles = triangulate_faces(mesh);
  }
  py::array_t<int> corners(std::vector<py::ssize_t>{static_cast<py::ssize_t>(triangles.corners.size()), 3});
  static_assert(sizeof(std::array<int, 3>) == 3 * sizeof(int));
  std::copy_n(reinterpret_cast<const int*>(triangles.corners.data()), 3 * triangles.corners.size(),
              corners.mutable_data());
  return py::make_tuple(corners, copy(triangles.face));
}

}  // namespace

void bind_quality(py::module_& module) {
  module.def("distortion", &distortion);
  module.def("map_defects", &map_defects);
  module.def("face_distortion", &face_distortion<float>, py::arg("vertices"), py::arg("face_offsets"),
             py::arg("corner_vertices"), py::arg("corner_uv").noconvert(), py::arg("selected_faces"));
  module.def("face_distortion", &face_distortion<double>);
  module.def("face_triangles", &face_triangles);
  module.def("rectangle_areas", &rectangle_areas);
}

}  // namespace spectral_conformal::python
