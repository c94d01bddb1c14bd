#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// A mesh that refers to arrays and keeps them alive.
struct MeshArrays {
  Array<double> vertices;
  Array<int> face_offsets;
  Array<int> corner_vertices;
  std::optional<Array<int>> seam_edges;
  std::optional<Array<bool>> selected_faces;

  PolygonMesh view() const {
    PolygonMesh mesh;
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

/// A mesh of triangles (F, 3) on vertices (V, 3).
MeshArrays triangle_mesh(const Array<double>& vertices, const Array<int>& triangles);

/// (V, 2)
py::array_t<double> real_view(const ComplexVector& z);
py::array_t<double> copy(const Eigen::VectorXd& values);
/// Wraps the values without a copy; their memory is freed with the array.
py::array_t<double> moved(Eigen::VectorXd&& values);
py::array_t<int> copy(const std::vector<int>& values);
py::array_t<bool> copy(const std::vector<bool>& values);

}  // namespace spectral_conformal::python
