#include "bindings/arrays.h"

#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

namespace spectral_conformal::python {

MeshArrays triangle_mesh(const Array<double>& vertices, const Array<int>& triangles) {
  const auto n = triangles.shape(0);
  Array<int> offsets(n + 1);
  for (py::ssize_t i = 0; i <= n; ++i) offsets.mutable_at(i) = static_cast<int>(3 * i);
  return {vertices, offsets, Array<int>(triangles).reshape({3 * n}), std::nullopt, std::nullopt};
}

py::array_t<double> real_view(const ComplexVector& z) {
  py::array_t<double> result({static_cast<py::ssize_t>(z.size()), static_cast<py::ssize_t>(2)});
  std::copy_n(reinterpret_cast<const double*>(z.data()), 2 * z.size(), result.mutable_data());
  return result;
}

py::array_t<double> copy(const Eigen::VectorXd& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<double> moved(Eigen::VectorXd&& values) {
  auto owner = std::make_unique<Eigen::VectorXd>(std::move(values));
  const double* data = owner->data();
  const auto n = static_cast<py::ssize_t>(owner->size());
  const py::capsule release(owner.get(), [](void* vector) { delete static_cast<Eigen::VectorXd*>(vector); });
  owner.release();
  return py::array_t<double>(n, data, release);
}

py::array_t<int> copy(const std::vector<int>& values) {
  return py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<bool> copy(const std::vector<bool>& values) {
  py::array_t<bool> result(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), result.mutable_data());
  return result;
}

}  // namespace spectral_conformal::python
