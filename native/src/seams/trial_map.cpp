#include "seams/trial_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "spectral_conformal/distortion.h"

namespace spectral_conformal {
namespace {

// Faces that a map all but collapses count as much as these, so that one of them does not outweigh all others.
constexpr double max_log2_scale = 16;
constexpr double max_qc = 1000;

/// Sums the triangles of each face up, of a quad those of one split.
void measure_faces(const Eigen::Ref<const Positions>& positions, TrialMap& mapped) {
  const Chart& chart = mapped.chart;
  const Distortion distortion = measure_distortion(positions, chart.triangles, chart.triangle_weights, mapped.z);
  std::vector<double> image(chart.faces.size(), 0);
  mapped.area.assign(chart.faces.size(), 0);
  mapped.qc.assign(chart.faces.size(), 0);
  for (const int t : distortion.triangulation) {
    const int face = chart.triangle_face[static_cast<std::size_t>(t)];
    mapped.area[face] += distortion.area[t];
    image[face] += distortion.image_area[t];
    mapped.qc[face] += distortion.area[t] * std::min(distortion.qc[t], max_qc);
  }
  for (std::size_t face = 0; face < chart.faces.size(); ++face) {
    const double area = mapped.area[face];
    const double scale = area > 0 ? 0.5 * std::log2(std::abs(image[face]) / area) : 0;
    mapped.log2_scale.push_back(std::clamp(scale, -max_log2_scale, max_log2_scale));
    mapped.qc[face] = area > 0 ? mapped.qc[face] / area : 1;
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

TrialMap solve_trial_map(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, const Progress& progress) {
  TrialMap result;
  result.chart = std::move(chart);
  const Positions positions = result.chart.positions(mesh);
  try {
    // A map that had to be replaced asks for a cut, and takes long.
    SolveOptions strict;
    strict.fallbacks = false;
    result.z = Solver(result.chart, positions, options).solve(strict, {}, progress).z;
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
  return scale_variance + 5 * (mean_qc - 1);  // 0.5^2 = 5 x 0.05
}

MapQuality map_quality(const TrialMaps& charts, double scale_limit) {
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
