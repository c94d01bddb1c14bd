#include "spectral_conformal/distortion.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/binary_unit.h"
#include "geometry/quad_splits.h"
#include "geometry/signed_area.h"
#include "geometry/triangle_shape.h"
#include "mesh/boundary_loops.h"
#include "mesh/charts.h"
#include "quality/flips.h"
#include "quality/overlap.h"
#include "quality/turning_number.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

std::vector<TriangleShape> frames_of(const Eigen::Ref<const Positions>& positions,
                                     const std::vector<std::array<int, 3>>& triangles) {
  std::vector<TriangleShape> result;
  result.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    result.push_back(local_isometric_frame(positions.row(a), positions.row(b), positions.row(c)));
  }
  poll(triangles.size());
  return result;
}

/// All measures per triangle.
Distortion measure_triangles(const std::vector<TriangleShape>& shapes, const std::vector<std::array<int, 3>>& triangles,
                             const ComplexVector& z) {
  const auto n = static_cast<Eigen::Index>(triangles.size());
  Distortion result;
  result.qc = Eigen::VectorXd::Ones(n);
  result.log2_scale = result.area = result.image_area = Eigen::VectorXd::Zero(n);
  run_blocks_in_parallel(n, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index t = begin; t < end; ++t) {
      const auto& [a, b, c] = triangles[static_cast<std::size_t>(t)];
      const TriangleShape& shape = shapes[static_cast<std::size_t>(t)];
      if (shape.clamped) continue;
      result.qc[t] = shape.quasi_conformal_distortion(z[b] - z[a], z[c] - z[a]);
      result.area[t] = shape.area();
      result.image_area[t] = signed_area(z[a], z[b], z[c]);
      result.log2_scale[t] = 0.5 * std::log2(std::abs(result.image_area[t]) / shape.area());
    }
  });
  return result;
}

/// Sets the numbers of the whole map from those of the triangles in `triangulation`.
void summarize(Distortion& d) {
  if (d.triangulation.empty()) return;
  double total = 0;
  d.max_qc = 0;
  for (const int t : d.triangulation) {
    d.max_qc = std::max(d.max_qc, d.qc[t]);
    total += d.area[t];
  }
  if (total > 0) {
    d.mean_qc = 0;
    double mean_scale = 0;
    for (const int t : d.triangulation) {
      if (d.area[t] == 0) continue;
      d.mean_qc += d.area[t] / total * d.qc[t];
      mean_scale += d.area[t] / total * d.log2_scale[t];
    }
    double variance = 0;
    poll(d.triangulation.size());
    for (const int t : d.triangulation) {
      if (d.area[t] > 0) variance += d.area[t] / total * std::pow(d.log2_scale[t] - mean_scale, 2);
    }
    d.log2_scale_deviation = std::isnan(variance) ? infinity : std::sqrt(variance);
  }
}

/// A mesh and a map, each in its own unit.
struct InUnits {
  Positions positions;
  ComplexVector z;
  BinaryUnit unit;        ///< of the mesh
  BinaryUnit image_unit;  ///< of the map
  InUnits(const PolygonMesh& mesh, const ComplexVector& map)
      : positions(Eigen::Map<const Positions>(mesh.positions, mesh.n_vertices, 3)), z(map) {
    for (int c = 0; c < mesh.n_corners(); ++c) {
      const int v = mesh.corner_vertices[c];
      for (int k = 0; k < 3; ++k) unit.include(positions(v, k));
      image_unit.include(z[v].real());
      image_unit.include(z[v].imag());
    }
    positions *= unit.scaled(1);
    z *= image_unit.scaled(1);
  }
  /// Converts measures from these units to those of the input.
  void restore(Distortion& d) const {
    for (Eigen::Index t = 0; t < d.area.size(); ++t) {
      if (d.area[t] > 0) d.log2_scale[t] += image_unit.exponent() - unit.exponent();
      d.area[t] = unit.area_of(d.area[t]);
      d.image_area[t] = image_unit.area_of(d.image_area[t]);
    }
  }
};

/// The map of the vertices of a chart.
ComplexVector chart_map(const Chart& chart, const ComplexVector& z) {
  ComplexVector own(chart.n_vertices());
  for (int v = 0; v < chart.n_vertices(); ++v) own[v] = z[chart.vertices[v]];
  return own;
}

std::vector<int> all_of(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<int> result(triangles.size());
  std::iota(result.begin(), result.end(), 0);
  return result;
}

}  // namespace

int Distortion::n_flipped() const { return static_cast<int>(std::count(flipped.begin(), flipped.end(), true)); }

double Distortion::qc_percentile(double fraction) const {
  if (triangulation.empty()) return 1;
  std::vector<double> values;
  values.reserve(triangulation.size());
  for (const int t : triangulation) values.push_back(qc[t]);
  poll(values.size());
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(below), values.end());
  const double low = values[below];
  if (below + 1 == values.size() || position == static_cast<double>(below)) return low;
  const double high = *std::min_element(values.begin() + static_cast<std::ptrdiff_t>(below) + 1, values.end());
  return std::isinf(high) ? high : low + (position - static_cast<double>(below)) * (high - low);
}

Distortion measure_distortion(const std::vector<TriangleShape>& shapes,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z) {
  Distortion result = measure_triangles(shapes, triangles, z);
  const ComplexVector oriented = positively_oriented(triangles, triangle_weights, z);
  result.triangulation = mapped_triangulation(triangles, triangle_weights, oriented);
  summarize(result);
  result.flipped.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    result.flipped[t] = !shapes[t].clamped && is_flipped(triangles[t], oriented);
  }
  poll(triangles.size());
  return result;
}

Distortion measure_distortion(const Eigen::Ref<const Positions>& positions,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<TriangleWeight>& triangle_weights, const ComplexVector& z) {
  return measure_distortion(frames_of(positions, triangles), triangles, triangle_weights, z);
}

double mean_quasi_conformal_distortion(const std::vector<TriangleShape>& shapes,
                                       const std::vector<std::array<int, 3>>& triangles,
                                       const std::vector<TriangleWeight>& triangle_weights, std::size_t n_triangles,
                                       const ComplexVector& z) {
  double sum = 0;
  double total = 0;
  for_each_mapped_triangle(n_triangles, triangles, triangle_weights, z, [&](std::size_t t) {
    const TriangleShape& shape = shapes[t];
    if (shape.clamped) return;
    const auto& [a, b, c] = triangles[t];
    sum += shape.area() * shape.quasi_conformal_distortion(z[b] - z[a], z[c] - z[a]);
    total += shape.area();
  });
  poll(n_triangles);
  return total > 0 ? sum / total : 1;
}

Distortion measure_mesh_distortion(const PolygonMesh& given, const ComplexVector& map) {
  validate(given);
  const InUnits in_units(given, map);
  const ComplexVector& z = in_units.z;
  PolygonMesh mesh = given;
  mesh.positions = in_units.positions.data();
  const ChartDecomposition decomposition = build_charts(mesh);
  std::vector<std::array<int, 3>> triangles(static_cast<std::size_t>(mesh.n_faces));
  for (int face = 0; face < mesh.n_faces; ++face) {
    if (mesh.n_corners(face) != 3) throw InvalidMesh(Rejection::not_triangle, face);
    const int* v = mesh.corner_vertices + mesh.face_offsets[face];
    triangles[face] = {v[0], v[1], v[2]};
  }
  for (const Chart& chart : decomposition.charts) {
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        triangles[chart.faces[chart.triangle_face[t]]][k] = chart.vertices[chart.triangles[t][k]];
      }
    }
  }
  const std::vector<TriangleShape> shapes = frames_of(in_units.positions, triangles);
  Distortion result = measure_triangles(shapes, triangles, z);
  result.triangulation = mapped_triangulation(triangles, {}, z);
  summarize(result);
  MapOfCharts charts;
  std::vector<char> is_in_chart(triangles.size(), 0);
  result.flipped.assign(triangles.size(), false);
  double largest = -1;
  for (const Chart& chart : decomposition.charts) {
    double area = 0;
    double image_area = 0;
    for (const int face : chart.faces) {
      area += result.area[face];
      image_area += result.image_area[face];
    }
    charts.add(chart, chart_map(chart, z), image_area < 0, all_of(chart.triangles), chart.faces);
    for (const int face : chart.faces) {
      is_in_chart[static_cast<std::size_t>(face)] = 1;
      const auto& triangle = triangles[static_cast<std::size_t>(face)];
      const bool against = image_area < 0 ? is_positive(triangle, z) : is_flipped(triangle, z);
      result.flipped[static_cast<std::size_t>(face)] = !shapes[static_cast<std::size_t>(face)].clamped && against;
    }
    if (area <= largest) continue;
    largest = area;
    result.turning_number = 0;
    if (chart.boundary_loops.empty()) continue;
    const int outer = outer_loop(chart.boundary_loops, chart.positions(mesh));
    result.turning_number =
        turning_number(chart.boundary_loops[outer], chart.triangles, chart.triangle_weights, chart_map(chart, z));
  }
  for (std::size_t face = 0; face < triangles.size(); ++face) {
    const auto& [a, b, c] = triangles[face];
    if (is_in_chart[face] == 0) charts.add_loose({z[a], z[b], z[c]}, static_cast<int>(face));
  }
  const std::vector<bool> overlapping = overlapping_in_map(charts);
  result.overlapping.assign(triangles.size(), false);
  for (std::size_t t = 0; t < overlapping.size(); ++t) result.overlapping[charts.face[t]] = overlapping[t];
  in_units.restore(result);
  return result;
}

}  // namespace spectral_conformal
