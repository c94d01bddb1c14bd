#include "seams/trial_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/triangle_shape.h"

namespace spectral_conformal {
namespace {

constexpr double greatest_log2_scale = 16;
constexpr double greatest_qc = 1000;

struct Triangle {
  double qc = 1;
  double area = 0;
  double image = 0;
};

Triangle measure(const Eigen::Ref<const Positions>& positions, const std::array<int, 3>& triangle,
                 const ComplexVector& z) {
  const auto& [a, b, c] = triangle;
  const TriangleShape shape = local_isometric_frame(positions.row(a), positions.row(b), positions.row(c));
  Triangle result;
  if (shape.clamped) return result;
  const Complex d1 = z[b] - z[a];
  const Complex d2 = z[c] - z[a];
  result.qc = std::min(shape.quasi_conformal_distortion(d1, d2), greatest_qc);
  result.area = shape.area();
  result.image = 0.5 * std::imag(std::conj(d1) * d2);
  return result;
}

/// Sums the triangles [first, last) up to one face's values.
void measure_face(const std::vector<Triangle>& triangles, std::size_t first, std::size_t last, MappedChart& result) {
  double area = 0;
  double image = 0;
  double weighted = 0;
  for (std::size_t t = first; t < last; ++t) {
    area += triangles[t].area;
    image += triangles[t].image;
    weighted += triangles[t].area * triangles[t].qc;
  }
  const double scale = area > 0 ? 0.5 * std::log2(std::abs(image) / area) : 0;
  result.area.push_back(area);
  result.log2_scale.push_back(std::clamp(scale, -greatest_log2_scale, greatest_log2_scale));
  result.qc.push_back(area > 0 ? weighted / area : 1);
}

void measure_faces(const Eigen::Ref<const Positions>& positions, MappedChart& mapped) {
  const Chart& chart = mapped.chart;
  std::vector<Triangle> triangles;
  std::size_t t = 0;
  for (int face = 0; t < chart.triangles.size(); ++face) {
    triangles.clear();
    const bool both_splits = chart.triangle_weights[t] != 1.0;
    for (; t < chart.triangles.size() && chart.triangle_face[t] == face; ++t) {
      triangles.push_back(measure(positions, chart.triangles[t], mapped.z));
    }
    std::size_t first = 0;
    if (both_splits) {
      // triangulate_polygon puts the four triangles of the two splits in a row.
      const auto worst = [&](int split) { return std::max(triangles[split].qc, triangles[split + 1].qc); };
      first = worst(0) <= worst(2) ? 0 : 2;
    }
    measure_face(triangles, first, both_splits ? first + 2 : triangles.size(), mapped);
  }
}

double weighted_median(std::vector<std::pair<double, double>>& value_and_weight, double total) {
  std::sort(value_and_weight.begin(), value_and_weight.end());
  double below = 0;
  for (const auto& [value, weight] : value_and_weight) {
    below += weight;
    if (2 * below >= total) return value;
  }
  return 0;
}

}  // namespace

MappedChart map_chart(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, const Progress& progress) {
  MappedChart result;
  result.chart = std::move(chart);
  const Positions positions = result.chart.positions(mesh);
  try {
    result.z = Solver(result.chart, positions, options).solve({}, {}, progress).z;
    result.solved = true;
  } catch (const InvalidMesh&) {
    return result;  // not solved, which is the answer
  } catch (const SolveFailure&) {
    return result;
  }
  measure_faces(positions, result);
  return result;
}

double MapQuality::distortion() const {
  if (!solved) return std::numeric_limits<double>::infinity();
  return scale_variance + 5 * (mean_qc - 1);
}

MapQuality map_quality(const std::vector<std::shared_ptr<const MappedChart>>& charts, double scale_limit) {
  MapQuality result;
  std::vector<std::pair<double, double>> scales;
  double qc = 0;
  for (const auto& mapped : charts) {
    result.solved = result.solved && mapped->solved;
    for (std::size_t f = 0; f < mapped->area.size(); ++f) {
      scales.emplace_back(mapped->log2_scale[f], mapped->area[f]);
      qc += mapped->area[f] * mapped->qc[f];
      result.area += mapped->area[f];
    }
  }
  if (!(result.area > 0)) return result;
  result.mean_qc = qc / result.area;
  result.median_log2_scale = weighted_median(scales, result.area);
  result.within_limit = 0;
  for (const auto& [scale, area] : scales) {
    const double offset = scale - result.median_log2_scale;
    result.scale_variance += area / result.area * offset * offset;
    if (std::abs(offset) <= std::log2(scale_limit)) result.within_limit += area / result.area;
  }
  return result;
}

}  // namespace spectral_conformal
