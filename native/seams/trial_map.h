#pragma once

#include <memory>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Trials that run at the same time, each in a thread: one of a large mesh takes hundreds of megabytes.
constexpr unsigned trials_at_once = 4;

/// Pieces of more vertices are searched on coarse copies first, of half as many, and get fewer trials.
constexpr int small_piece = 2000;
/// Of larger pieces no other is searched at the same time, as their maps take much memory, and no more than has to be
/// is solved for: on a sword of 22,000 vertices such haste saved nothing and left the energy above its limit.
constexpr int large_piece = 60000;

/// A chart with its spectral map and the distortion of each face; no distortion if not solved.
struct TrialMap {
  Chart chart;
  bool solved = false;
  ComplexVector z;                 ///< (V,) as Solver::solve returns it: its area is that in 3D
  std::vector<double> area;        ///< per face of the chart, in 3D
  std::vector<double> log2_scale;  ///< per face, log2 of the root of (area in the plane / area in 3D), within +-16
  std::vector<double> qc;          ///< per face, weighted by area, each triangle's at most 1000
  std::vector<int> flipped;        ///< faces with a flipped triangle, as indices into the chart's, ascending
};

/// Solves a chart of `mesh`, with `fallbacks` as in SolveOptions: a map that needs replacement calls for a cut, and
/// takes long. If the chart cannot be solved, `solved` is false. Throws Cancelled.
TrialMap solve_trial_map(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, bool fallbacks,
                         const Progress& progress);

/// The faces that must be cut before texturing: flipped, or covering part of another face. Indices into the chart's
/// faces, ascending; empty if the chart is not solved.
std::vector<int> defective_faces(const TrialMap& mapped);

/// The maps of the charts of a mesh, shared by the trials that leave a chart unchanged.
using TrialMaps = std::vector<std::shared_ptr<const TrialMap>>;

/// The distortion of several charts together.
struct MapQuality {
  bool solved = true;            ///< all charts are
  double median_log2_scale = 0;  ///< weighted by area
  double within_limit = 1;       ///< fraction of the area whose scale is within a factor of the median
  double mean_qc = 1;            ///< weighted by area
  /// Symmetric Dirichlet energy s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 of the faces' singular values at the median scale,
  /// mean weighted by area: 4 for an isometry. It grows with the square of the logarithm beyond a scale of 2 or a QC of
  /// 4 (with_inverse), so that neither a sliver nor the end of a long limb, whose energy is astronomical, outweighs all
  /// else.
  double energy = 4;
  double rms_excess = 0;  ///< root mean square of the faces' energies above 4
  double shear = 0;       ///< the part of energy - 4 that the angles have in it: what would be left at one scale
  double area = 0;

  /// The energy above that of an isometry; infinite where a chart is not solved.
  double distortion() const;
};

/// ratio + 1 / ratio, and beyond a ratio of 4 or 1 / 4 the parabola in its logarithm that continues it smoothly. The
/// symmetric Dirichlet energy is that of the ratio of the singular values times that of their product.
double with_inverse(double ratio);

/// `scale_limit` is the factor of within_limit, above 1.
MapQuality map_quality(const TrialMaps& charts, double scale_limit);

}  // namespace spectral_conformal
