#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "bindings/space_metric.h"
#include "geometry/triangle_shape.h"

namespace spectral_conformal::python {

Eigen::Vector3d corner(const Array<double>& vertices, const Array<int>& triangles, py::ssize_t t, int k) {
  return Eigen::Map<const Eigen::Vector3d>(vertices.data(triangles.at(t, k), 0));
}

Eigen::Matrix<double, 2, 3> frame_of(const Array<double>& vertices, const Array<int>& triangles, py::ssize_t t) {
  return tangent_frame(corner(vertices, triangles, t, 0), corner(vertices, triangles, t, 1),
                       corner(vertices, triangles, t, 2));
}

std::vector<SpaceMetric> space_metric(const Array<double>& vertices, const Array<int>& triangles,
                                      const std::optional<Array<double>>& metric) {
  std::vector<SpaceMetric> result;
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

namespace {

void set_metric(Array<double>& metric, py::ssize_t t, const TriangleMetric& g) {
  metric.mutable_at(t, 0, 0) = g.xx;
  metric.mutable_at(t, 0, 1) = metric.mutable_at(t, 1, 0) = g.xy;
  metric.mutable_at(t, 1, 1) = g.yy;
}

py::array_t<double> metric_from_uv(const Array<double>& vertices, const Array<int>& triangles,
                                   const Array<double>& uv) {
  const py::ssize_t n = triangles.shape(0);
  Array<double> metric({n, py::ssize_t{2}, py::ssize_t{2}});
  for (py::ssize_t t = 0; t < n; ++t) {
    const auto image = [&](int k) {
      const int v = triangles.at(t, k);
      return Complex(uv.at(v, 0), uv.at(v, 1));
    };
    const TriangleShape shape = local_isometric_frame(
        corner(vertices, triangles, t, 0), corner(vertices, triangles, t, 1), corner(vertices, triangles, t, 2));
    set_metric(metric, t,
               shape.clamped ? TriangleMetric{} : metric_of_map(shape, image(1) - image(0), image(2) - image(0)));
  }
  return metric;
}

py::array_t<double> metric_from_direction(const Array<double>& vertices, const Array<int>& triangles,
                                          const Array<double>& directions, const Array<double>& ratios) {
  const py::ssize_t n = triangles.shape(0);
  Array<double> metric({n, py::ssize_t{2}, py::ssize_t{2}});
  for (py::ssize_t t = 0; t < n; ++t) {
    const Eigen::Map<const Eigen::Vector3d> direction(directions.data(t, 0));
    set_metric(metric, t, metric_along(direction, ratios.at(t), frame_of(vertices, triangles, t)));
  }
  return metric;
}

TriangleMetric metric_at(const Array<double>& metric, py::ssize_t t) {
  return {metric.at(t, 0, 0), metric.at(t, 0, 1), metric.at(t, 1, 1)};
}

py::array_t<double> blend_metric(const Array<double>& metric, double amount) {
  Array<double> result({metric.shape(0), py::ssize_t{2}, py::ssize_t{2}});
  for (py::ssize_t t = 0; t < metric.shape(0); ++t) set_metric(result, t, blend(metric_at(metric, t), amount));
  return result;
}

/// The first metric that is not positive definite, or -1.
py::ssize_t first_not_positive_definite(const Array<double>& metric) {
  for (py::ssize_t t = 0; t < metric.shape(0); ++t) {
    if (!is_positive_definite(metric_at(metric, t))) return t;
  }
  return -1;
}

}  // namespace

void bind_metric(py::module_& module) {
  module.def("metric_from_uv", &metric_from_uv);
  module.def("metric_from_direction", &metric_from_direction);
  module.def("blend_metric", &blend_metric);
  module.def("first_not_positive_definite", &first_not_positive_definite);
}

}  // namespace spectral_conformal::python
