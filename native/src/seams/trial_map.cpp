#include "seams/trial_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "quality/overlap.h"
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
    if (distortion.flipped[static_cast<std::size_t>(t)]) mapped.flipped.push_back(face);
  }
  std::sort(mapped.flipped.begin(), mapped.flipped.end());
  mapped.flipped.erase(std::unique(mapped.flipped.begin(), mapped.flipped.end()), mapped.flipped.end());
  for (std::size_t face = 0; face < chart.faces.size(); ++face) {
    const double area = mapped.area[face];
    const double scale = area > 0 ? 0.5 * std::log2(std::abs(image[face]) / area) : 0;
    mapped.log2_scale.push_back(std::clamp(scale, -max_log2_scale, max_log2_scale));
    mapped.qc[face] = area > 0 ? mapped.qc[face] / area : 1;
  }
}

/// 2 cosh t, and beyond t = ln 4 the parabola that continues it smoothly.
double bounded_cosh(double t) {
  constexpr double from = 1.386294361119890618834464242916;
  const double beyond = std::abs(t) - from;
  if (beyond <= 0) return 2 * std::cosh(t);
  return std::cosh(from) * (2 + beyond * beyond) + 2 * std::sinh(from) * beyond;
}

/// By bisection of the values around a pivot, the middle one by position of those that are left.
double weighted_median(std::vector<std::pair<double, double>>& value_and_weight, double total) {
  auto first = value_and_weight.begin();
  auto last = value_and_weight.end();
  double below = 0;
  while (last - first > 1) {
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last);
    double left = below;
    for (auto i = first; i != middle; ++i) left += i->second;
    if (2 * left >= total) {
      last = middle;
    } else {
      below = left;
      first = middle;
    }
  }
  return first == last ? 0 : first->first;
}

}  // namespace

TrialMap solve_trial_map(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, bool fallbacks,
                         const Progress& progress) {
  TrialMap result;
  result.chart = std::move(chart);
  const Positions positions = result.chart.positions(mesh);
  try {
    SolveOptions solve;
    solve.fallbacks = fallbacks;
    // None of 886 maps that failed on bodies with limbs, which wind, passed then.
    solve.second_attempt = fallbacks;
    result.z = Solver(result.chart, positions, options).solve(solve, {}, progress).z;
    result.solved = true;
  } catch (const InvalidMesh&) {
    return result;  // not solved, which is the answer
  } catch (const SolveFailure&) {
    return result;
  }
  measure_faces(positions, result);
  return result;
}

std::vector<int> defective_faces(const TrialMap& mapped) {
  if (!mapped.solved) return {};
  const std::vector<int> overlapping = overlapping_faces(mapped.chart, mapped.z);
  std::vector<int> result;
  std::set_union(overlapping.begin(), overlapping.end(), mapped.flipped.begin(), mapped.flipped.end(),
                 std::back_inserter(result));
  return result;
}

double MapQuality::distortion() const { return solved ? energy - 4 : std::numeric_limits<double>::infinity(); }

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
  result.energy = 0;
  for (const auto& mapped : charts) {
    for (std::size_t f = 0; f < mapped->area.size(); ++f) {
      const double weight = mapped->area[f] / result.area;
      const double offset = mapped->log2_scale[f] - result.median_log2_scale;
      // (s1^2 + s2^2) (1 + 1 / (s1 s2)^2), by the ratio and the product of the singular values.
      const double shear = bounded_cosh(std::log(mapped->qc[f]));
      result.energy += weight * shear * bounded_cosh(2 * std::log(2.0) * offset);
      result.shear += weight * 2 * (shear - 2);
      if (std::abs(offset) <= std::log2(scale_limit)) result.within_limit += weight;
    }
  }
  return result;
}

}  // namespace spectral_conformal
