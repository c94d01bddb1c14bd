#include "seams/trial_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "concurrency/parallel_calls.h"
#include "quality/overlap.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/distortion.h"

namespace spectral_conformal {
namespace {

// Faces that a map all but collapses count as much as this, so that one of them does not outweigh all others.
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
  mapped.sums = DistortionSums(mapped.area, mapped.log2_scale, mapped.qc);
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
  call_while_listening(work_per_face * static_cast<double>(result.chart.triangles.size()),
                       [&] { measure_faces(positions, result); });
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

double MapQuality::distortion() const { return solved ? energy - 4 : infinity; }

MapQuality map_quality(const TrialMaps& charts, double scale_limit) {
  MapQuality result;
  std::vector<const DistortionSums*> all;
  double qc = 0;
  for (const auto& mapped : charts) {
    result.solved = result.solved && mapped->solved;
    if (mapped->sums.n_faces() == 0) continue;
    all.push_back(&mapped->sums);
    qc += mapped->sums.qc();
    result.area += mapped->sums.area();
  }
  if (!(result.area > 0)) return result;
  result.mean_qc = qc / result.area;
  result.median_log2_scale = DistortionSums::median_log2_scale(all, result.area);
  const double limit = std::log2(scale_limit);
  double within = 0;
  double energy = 0;
  double shear = 0;
  for (const DistortionSums* sums : all) {
    within += sums->area_up_to(result.median_log2_scale + limit) - sums->area_below(result.median_log2_scale - limit);
    energy += sums->energy(result.median_log2_scale);
    shear += sums->shear();
  }
  result.within_limit = within / result.area;
  result.energy = energy / result.area;
  result.shear = shear / result.area;
  return result;
}

}  // namespace spectral_conformal
