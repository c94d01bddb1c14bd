#include "spectral_conformal/distortion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/triangle_shape.h"
#include "mesh/boundary_loops.h"
#include "quality/overlap.h"
#include "quality/turning_number.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

/// Value at a fraction of the sorted values, linearly interpolated as NumPy's percentile does. Reorders the values.
double percentile(std::vector<double>& values, double fraction) {
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(below), values.end());
  const double low = values[below];
  if (below + 1 == values.size() || position == static_cast<double>(below)) return low;
  const double high = *std::min_element(values.begin() + static_cast<std::ptrdiff_t>(below) + 1, values.end());
  return std::isinf(high) ? high : low + (position - static_cast<double>(below)) * (high - low);
}

struct Measures {
  Distortion distortion;
  std::vector<double> area;         ///< in 3D, times the triangle weight; 0 for clamped triangles
  std::vector<double> signed_area;  ///< of the image
};

/// Everything that is measured triangle by triangle.
Measures measure_triangles(const Eigen::Ref<const Positions>& positions,
                           const std::vector<std::array<int, 3>>& triangles,
                           const std::vector<double>& triangle_weights, const ComplexVector& z) {
  const std::size_t n = triangles.size();
  Measures result;
  result.area.assign(n, 0);
  result.signed_area.assign(n, 0);
  Distortion& distortion = result.distortion;
  distortion.qc = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(n));
  distortion.log2_scale = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (std::size_t t = 0; t < n; ++t) {
    const auto& [a, b, c] = triangles[t];
    const TriangleShape shape = local_isometric_frame(positions.row(a), positions.row(b), positions.row(c));
    if (shape.clamped) continue;
    const Complex d1 = z[b] - z[a];
    const Complex d2 = z[c] - z[a];
    distortion.qc[static_cast<Eigen::Index>(t)] = shape.quasi_conformal_distortion(d1, d2);
    const double share = triangle_weights.empty() ? 1.0 : triangle_weights[t];
    result.area[t] = share * shape.area();
    const double image = 0.5 * std::imag(std::conj(d1) * d2);
    result.signed_area[t] = share * image;
    distortion.log2_scale[static_cast<Eigen::Index>(t)] = 0.5 * std::log2(std::abs(image) / shape.area());
  }
  return result;
}

void summarize(Measures& measures) {
  Distortion& d = measures.distortion;
  const auto n = d.qc.size();
  if (n == 0) return;
  const Eigen::Map<const Eigen::VectorXd> area(measures.area.data(), n);
  const double total = area.sum();
  if (total > 0) {
    d.mean_qc = 0;
    double mean_scale = 0;
    for (Eigen::Index t = 0; t < n; ++t) {
      if (area[t] == 0) continue;
      d.mean_qc += area[t] / total * d.qc[t];
      mean_scale += area[t] / total * d.log2_scale[t];
    }
    double variance = 0;
    for (Eigen::Index t = 0; t < n; ++t) {
      if (area[t] > 0) variance += area[t] / total * std::pow(d.log2_scale[t] - mean_scale, 2);
    }
    d.log2_scale_deviation = std::isnan(variance) ? std::numeric_limits<double>::infinity() : std::sqrt(variance);
  }
  d.max_qc = d.qc.maxCoeff();
  std::vector<double> values(d.qc.data(), d.qc.data() + n);
  d.p95_qc = percentile(values, 0.95);
  d.p99_qc = percentile(values, 0.99);
}

/// The exponent of the power of two next to the largest of some finite values; bounded, so that it has an inverse.
int binary_exponent(double largest) {
  constexpr int bound = 1000;
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::clamp(exponent, -bound, bound);
}

/// A mesh and a map in units of their own, powers of two, in which squares of lengths neither overflow nor vanish.
struct InUnits {
  Positions positions;
  ComplexVector z;
  double log2_unit_ratio = 0;  ///< log2 of the map's unit over the mesh's
  InUnits(const PolygonMesh& mesh, const ComplexVector& map)
      : positions(Eigen::Map<const Positions>(mesh.positions, mesh.n_vertices, 3)), z(map) {
    double largest = 0;
    double largest_image = 0;
    const int n_corners = mesh.n_faces == 0 ? 0 : mesh.face_offsets[mesh.n_faces];
    for (int c = 0; c < n_corners; ++c) {
      const int v = mesh.corner_vertices[c];
      largest = std::max(largest, positions.row(v).cwiseAbs().maxCoeff());
      largest_image = std::max({largest_image, std::abs(z[v].real()), std::abs(z[v].imag())});
    }
    const int unit = binary_exponent(largest);
    const int image_unit = binary_exponent(largest_image);
    positions *= std::ldexp(1.0, -unit);
    z *= std::ldexp(1.0, -image_unit);
    log2_unit_ratio = image_unit - unit;
  }
};

}  // namespace

Distortion measure_distortion(const Eigen::Ref<const Positions>& positions,
                              const std::vector<std::array<int, 3>>& triangles,
                              const std::vector<double>& triangle_weights, const ComplexVector& z) {
  Measures measures = measure_triangles(positions, triangles, triangle_weights, z);
  summarize(measures);
  double total = 0;
  for (const double area : measures.signed_area) total += area;
  measures.distortion.flipped.resize(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    measures.distortion.flipped[t] = measures.signed_area[t] * (total < 0 ? -1 : 1) < 0;
  }
  return std::move(measures.distortion);
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
    if (mesh.face_offsets[face + 1] != mesh.face_offsets[face] + 3) {
      throw InvalidMesh("Face " + std::to_string(face) + " is no triangle.");
    }
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
  Measures measures = measure_triangles(in_units.positions, triangles, {}, z);
  summarize(measures);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (measures.area[t] > 0) measures.distortion.log2_scale[static_cast<Eigen::Index>(t)] += in_units.log2_unit_ratio;
  }
  Distortion& result = measures.distortion;
  result.overlapping = overlapping_triangles(triangles, z);
  result.flipped.assign(triangles.size(), false);
  double largest = -1;
  for (const Chart& chart : decomposition.charts) {
    double area = 0;
    double image = 0;
    for (const int face : chart.faces) {
      area += measures.area[face];
      image += measures.signed_area[face];
    }
    for (const int face : chart.faces) result.flipped[face] = measures.signed_area[face] * (image < 0 ? -1 : 1) < 0;
    if (area <= largest) continue;
    largest = area;
    result.turning_number = 0;
    if (chart.boundary_loops.empty()) continue;
    const int outer = outer_loop(chart.boundary_loops, chart.positions(mesh));
    ComplexVector own(chart.n_vertices());
    for (int v = 0; v < chart.n_vertices(); ++v) own[v] = z[chart.vertices[v]];
    result.turning_number = turning_number(chart.boundary_loops[outer], chart.triangles, chart.triangle_weights, own);
  }
  return std::move(measures.distortion);
}

}  // namespace spectral_conformal
