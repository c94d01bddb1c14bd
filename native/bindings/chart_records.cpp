#include "bindings/chart_records.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/options.h"

namespace spectral_conformal::python {

namespace {

/// A chart except its faces and texts, under Python's field names.
struct Row {
  double eigenvalue;
  double residual;
  double mean_qc;
  double max_qc;
  double scale_deviation_before;
  double scale_deviation;
  double hole_rigidity;
  double mean_qc_before;
  double area;
  double image_area;
  double low_u;
  double low_v;
  double high_u;
  double high_v;
  int clamped_triangles;
  int iterations;
  int attempts;
  int turning_number;
  int flipped;
  int overlapping;
  int polish_steps;
  int unfolded;
  int n_pins;
  int n_vertices;
  int n_faces;
  unsigned char status;
  unsigned char method;
  unsigned char weights;
  unsigned char boundary;
  unsigned char fallback;
  unsigned char eigenvalue_of;
  unsigned char relaxation;
  bool is_embedding;
  bool reused;
};

Row row_of(const UnwrappedChart& chart) {
  Row row{};
  row.eigenvalue = chart.eigenvalue;
  row.residual = chart.residual;
  row.mean_qc = chart.mean_qc;
  row.max_qc = chart.max_qc;
  row.scale_deviation_before = chart.scale_deviation_before;
  row.scale_deviation = chart.scale_deviation;
  row.hole_rigidity = chart.hole_rigidity;
  row.mean_qc_before = chart.mean_qc_before;
  row.area = chart.area;
  row.image_area = chart.image_area;
  row.low_u = chart.low.real();
  row.low_v = chart.low.imag();
  row.high_u = chart.high.real();
  row.high_v = chart.high.imag();
  row.clamped_triangles = chart.clamped_triangles;
  row.iterations = chart.iterations;
  row.attempts = chart.attempts;
  row.turning_number = chart.turning_number;
  row.flipped = chart.flipped;
  row.overlapping = chart.overlapping;
  row.polish_steps = chart.polish_steps;
  row.unfolded = chart.unfolded;
  row.n_pins = chart.n_pins;
  row.n_vertices = chart.n_vertices;
  row.n_faces = static_cast<int>(chart.faces.size());
  row.status = chart.solved ? 1 : 0;
  row.method = code_of(chart.method);
  row.weights = code_of(chart.weights);
  row.boundary = code_of(chart.boundary);
  row.fallback = code_of(chart.fallback);
  row.eigenvalue_of = code_of(chart.eigenvalue_of);
  row.relaxation = code_of(chart.relaxation);
  row.is_embedding = chart.is_embedding;
  row.reused = chart.reused;
  return row;
}

}  // namespace

py::tuple chart_records(std::vector<UnwrappedChart>&& charts) {
  std::size_t n_faces = 0;
  for (const UnwrappedChart& chart : charts) n_faces += chart.faces.size();
  py::array_t<Row> rows(static_cast<py::ssize_t>(charts.size()));
  py::array_t<int> faces(static_cast<py::ssize_t>(n_faces));
  py::dict remarks;
  Row* row = rows.mutable_data();
  int* face = faces.mutable_data();
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const UnwrappedChart chart = std::move(charts[i]);
    *row++ = row_of(chart);
    face = std::copy(chart.faces.begin(), chart.faces.end(), face);
    if (!chart.steps.empty()) remarks[py::int_(i)] = steps_of(chart.steps);
  }
  return py::make_tuple(rows, faces, remarks);
}

void bind_chart_records(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(Row, eigenvalue, residual, mean_qc, max_qc, scale_deviation_before, scale_deviation,
                       hole_rigidity, mean_qc_before, area, image_area, low_u, low_v, high_u, high_v, clamped_triangles,
                       iterations, attempts, turning_number, flipped, overlapping, polish_steps, unfolded, n_pins,
                       n_vertices, n_faces, status, method, weights, boundary, fallback, eigenvalue_of, relaxation,
                       is_embedding, reused);
  py::dict names = names_of_codes();
  names["status"] = py::make_tuple("failed", "solved");
  module.attr("CHART_NAMES") = names;
  module.attr("CHART_FIELDS") = py::dtype::of<Row>().attr("names");
}

}  // namespace spectral_conformal::python
