#include "seams/trial_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "geometry/bounding_rectangles.h"
#include "graph/mixed_bits.h"
#include "quality/overlap.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/distortion.h"

namespace spectral_conformal {
namespace {

// Bounds for nearly collapsed faces, so that one of them does not outweigh all others.
constexpr double max_qc = 1000;
constexpr double max_log2_scale = 16;
/// Of the grid on which faces are measured: coarse beside the rounding errors of maps, which differ from processor to
/// processor, so that what is equal by symmetry stays equal.
constexpr double unit_of_measures = 0x1p-20;

double on_grid(double measure) { return std::round(measure / unit_of_measures) * unit_of_measures; }

/// Sums up the triangles of each face; for a quad, those of one split.
void measure_faces(const Eigen::Ref<const Positions>& positions, TrialMap& mapped) {
  const Chart& chart = mapped.chart;
  const Distortion distortion = measure_distortion(positions, chart.triangles, chart.triangle_weights, mapped.z);
  std::vector<double> image(chart.faces.size(), 0);
  mapped.area.assign(chart.faces.size(), 0);
  mapped.qc.assign(chart.faces.size(), 0);
  for (const int t : distortion.triangulation) {
    const int face = chart.triangle_face[t];
    mapped.area[face] += distortion.area[t];
    image[face] += distortion.image_area[t];
    mapped.qc[face] += distortion.area[t] * std::min(distortion.qc[t], max_qc);
    if (distortion.flipped[t]) mapped.flipped.push_back(face);
  }
  std::sort(mapped.flipped.begin(), mapped.flipped.end());
  mapped.flipped.erase(std::unique(mapped.flipped.begin(), mapped.flipped.end()), mapped.flipped.end());
  for (std::size_t face = 0; face < chart.faces.size(); ++face) {
    const double area = mapped.area[face];
    const double scale = area > 0 ? 0.5 * std::log2(std::abs(image[face]) / area) : 0;
    mapped.log2_scale.push_back(on_grid(std::clamp(scale, -max_log2_scale, max_log2_scale)));
    mapped.qc[face] = area > 0 ? on_grid(mapped.qc[face] / area) : 1;
  }
}

/// The least value such that it and smaller ones have at least half of the weight, `total`.
double weighted_median(std::vector<std::pair<double, double>> values_and_weights, double total) {
  auto first = values_and_weights.begin();
  auto last = values_and_weights.end();
  double before = 0;
  while (last - first > 1) {
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last);
    double up_to_middle = before;
    for (auto at = first; at != middle; ++at) up_to_middle += at->second;
    if (2 * up_to_middle >= total) {
      last = middle;
    } else {
      before = up_to_middle;
      first = middle;
    }
  }
  return first->first;
}

}  // namespace

TrialMap solve_trial_map(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, bool fallbacks,
                         const Progress& progress) {
  TrialMap result;
  result.chart = std::move(chart);
  result.digest = ChartKey(result.chart).digest;
  const Positions positions = result.chart.positions(mesh);
  try {
    SolveOptions solve;
    solve.fallbacks = fallbacks;
    // It rescued none of 886 failed maps of bodies with limbs, which wind.
    solve.second_attempt = fallbacks;
    result.z = Solver::of(result.chart, positions, options).solve(solve, {}, progress).z;
    result.solved = true;
  } catch (const InvalidMesh&) {
    return result;  // not solved: that is the answer
  } catch (const SolveFailure&) {
    return result;
  }
  call_while_polling(steps_per_face * result.chart.triangles.size(), [&] { measure_faces(positions, result); });
  return result;
}

std::vector<int> defective_faces(const TrialMap& mapped) {
  if (!mapped.solved) return {};
  return mapped.defects.get([&] {
    const std::vector<int> overlapping = overlapping_faces(mapped.chart, mapped.z);
    std::vector<int> result;
    std::set_union(overlapping.begin(), overlapping.end(), mapped.flipped.begin(), mapped.flipped.end(),
                   std::back_inserter(result));
    return result;
  });
}

double longer_side(const TrialMap& mapped) {
  if (!mapped.solved) return 0;
  return mapped.side.get([&] {
    std::vector<Complex> border;
    for (const BoundaryLoop& loop : mapped.chart.boundary_loops) {
      for (const int v : loop) border.push_back(mapped.z[v]);
    }
    const Rectangle smallest = smallest_rectangles(convex_hull(std::move(border)), 0).front();
    // In single precision, so that rounding does not decide.
    return static_cast<double>(static_cast<float>(std::max(smallest.width, smallest.height)));
  });
}

ChartKey::ChartKey(const Chart& sought) : chart(sought), digest(sought.boundary_loops.size()) {
  for (const std::vector<int>* numbers : {&sought.faces, &sought.vertices}) {
    for (const int k : *numbers) digest = (digest ^ static_cast<std::uint32_t>(k)) * golden_increment;
    digest = mixed_bits(digest + numbers->size());
  }
}

bool ChartOrder::precedes(const Chart& a, const Chart& b) {
  if (&a == &b) return false;
  if (a.boundary_loops.size() != b.boundary_loops.size()) return a.boundary_loops.size() < b.boundary_loops.size();
  // Mostly they are equal, which is quickly seen.
  if (a.faces != b.faces) return a.faces < b.faces;
  if (a.vertices != b.vertices) return a.vertices < b.vertices;
  return !(a.triangles == b.triangles) && a.triangles.vector() < b.triangles.vector();
}

double MapQuality::distortion() const { return solved ? energy - 4 : infinity; }

double with_inverse(double ratio) {
  const double larger = std::max(ratio, 1 / ratio);
  if (!(larger > 4)) return larger + 1 / larger;
  const double beyond = std::log(larger / 4);
  // 2 cosh(ln 4) = 17 / 4 and sinh(ln 4) = 15 / 8.
  return 17.0 / 8 * (2 + beyond * beyond) + 15.0 / 4 * beyond;
}

double squared_excess(const TrialMap& mapped, double median_log2_scale) {
  double sum = 0;
  for (std::size_t f = 0; f < mapped.area.size(); ++f) {
    const double by_scale = with_inverse(std::exp2(2 * (mapped.log2_scale[f] - median_log2_scale)));
    const double excess = with_inverse(mapped.qc[f]) * by_scale - 4;
    sum += mapped.area[f] * excess * excess;
  }
  return sum;
}

MapQuality map_quality(const TrialMaps& charts, double scale_limit) {
  MapQuality result;
  std::size_t n_faces = 0;
  for (const auto& mapped : charts) n_faces += mapped->area.size();
  std::vector<std::pair<double, double>> scales_and_areas;
  scales_and_areas.reserve(n_faces);
  double qc = 0;
  for (const auto& mapped : charts) {
    result.solved = result.solved && mapped->solved;
    for (std::size_t f = 0; f < mapped->area.size(); ++f) {
      scales_and_areas.emplace_back(mapped->log2_scale[f], mapped->area[f]);
      result.area += mapped->area[f];
      qc += mapped->area[f] * mapped->qc[f];
    }
  }
  if (!(result.area > 0)) return result;
  result.mean_qc = qc / result.area;
  if (!result.solved) return result;
  result.median_log2_scale = weighted_median(std::move(scales_and_areas), result.area);
  const double limit = std::log2(scale_limit);
  double within = 0;
  double excess = 0;
  double squares = 0;
  double shear = 0;
  for (const auto& mapped : charts) {
    for (std::size_t f = 0; f < mapped->area.size(); ++f) {
      const double area = mapped->area[f];
      const double offset = mapped->log2_scale[f] - result.median_log2_scale;
      const double by_angles = with_inverse(mapped->qc[f]);
      const double of_face = by_angles * with_inverse(std::exp2(2 * offset)) - 4;
      within += std::abs(offset) <= limit ? area : 0;
      excess += area * of_face;
      squares += area * of_face * of_face;
      shear += area * 2 * (by_angles - 2);
    }
  }
  result.within_limit = within / result.area;
  result.energy = 4 + excess / result.area;
  result.rms_excess = std::sqrt(squares / result.area);
  result.shear = shear / result.area;
  return result;
}

}  // namespace spectral_conformal
