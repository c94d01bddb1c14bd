#include "seams/distorted_regions.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "mesh/boundary_loops.h"
#include "seams/field_extrema.h"

namespace spectral_conformal {
namespace {

/// Extrema of the scale with less prominence, in log2, are ignored: a factor of 1.2 is hardly visible.
constexpr double min_prominence = 0.25;

/// Per vertex of a chart: 0 inside, 1 on the outer loop, 2 on another.
std::vector<char> loop_of_vertex(const PolygonMesh& mesh, const Chart& chart) {
  std::vector<char> result(chart.vertices.size(), 0);
  const int outer = outer_loop(chart.boundary_loops, chart.positions(mesh));
  for (std::size_t i = 0; i < chart.boundary_loops.size(); ++i) {
    for (const int v : chart.boundary_loops[i]) result[v] = static_cast<int>(i) == outer ? 1 : 2;
  }
  return result;
}

}  // namespace

std::vector<DistortedRegion> scale_extrema(const PolygonMesh& mesh, const TrialMap& mapped, double median_log2_scale) {
  std::vector<DistortedRegion> regions;
  const Chart& chart = mapped.chart;
  std::vector<double> area(chart.vertices.size(), 0);
  std::vector<double> field(chart.vertices.size(), 0);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    const int face = chart.triangle_face[t];
    // Above 0 even without area: such triangles count if a vertex has no others.
    const double weight = chart.triangle_weights[t] * mapped.area[face] + 1e-300;
    for (const int v : chart.triangles[t]) {
      area[v] += weight;
      field[v] += weight * mapped.log2_scale[face];
    }
  }
  for (std::size_t v = 0; v < field.size(); ++v) {
    field[v] = area[v] > 0 ? field[v] / area[v] - median_log2_scale : 0;
  }
  const std::vector<char> loop = loop_of_vertex(mesh, chart);
  const Adjacency neighbors = neighbors_along(chart.triangles, chart.n_vertices());
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> signed_field = field;
    for (double& value : signed_field) value *= sign;
    for (const FieldMinimum& minimum : prominent_minima(signed_field, area, neighbors, 0, min_prominence)) {
      if (loop[minimum.vertex] == 1 || (loop[minimum.vertex] == 2 && sign < 0)) continue;
      regions.push_back({chart.vertices[minimum.vertex], loop[minimum.vertex] == 2, minimum.volume});
    }
  }
  return regions;
}

std::vector<DistortedRegion> angle_peaks(const PolygonMesh& mesh, const TrialMap& mapped) {
  std::vector<DistortedRegion> regions;
  const Chart& chart = mapped.chart;
  std::vector<double> excess(chart.vertices.size(), 0);
  for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
    const int face = chart.triangle_face[t];
    for (const int v : chart.triangles[t])
      excess[v] += chart.triangle_weights[t] * mapped.area[face] * (mapped.qc[face] - 1);
  }
  std::vector<char> highest(chart.vertices.size(), 1);
  for (const auto& triangle : chart.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k];
      const int b = triangle[(k + 1) % 3];
      highest[excess[a] < excess[b] || (excess[a] == excess[b] && a > b) ? a : b] = 0;
    }
  }
  const std::vector<char> loop = loop_of_vertex(mesh, chart);
  for (int v = 0; v < chart.n_vertices(); ++v) {
    if (highest[v] != 0 && loop[v] != 1) regions.push_back({chart.vertices[v], loop[v] == 2, excess[v]});
  }
  return regions;
}

}  // namespace spectral_conformal
