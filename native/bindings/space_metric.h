#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <vector>

#include "bindings/arrays.h"
#include "spectral_conformal/metric.h"

namespace spectral_conformal::python {

/// Corner k of triangle t.
Eigen::Vector3d corner(const Array<double>& vertices, const Array<int>& triangles, py::ssize_t t, int k);
Eigen::Matrix<double, 2, 3> frame_of(const Array<double>& vertices, const Array<int>& triangles, py::ssize_t t);

/// Tensors in 3D from a metric (F, 2, 2) in the frames of the triangles' first sides, or (n, 3, 3) unchanged.
std::vector<SpaceMetric> space_metric(const Array<double>& vertices, const Array<int>& triangles,
                                      const std::optional<Array<double>>& metric);

}  // namespace spectral_conformal::python
