#pragma once

#include <memory>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A chart with its spectral map and the distortion of each of its faces. Not solved: no distortion.
struct TrialMap {
  Chart chart;
  bool solved = false;
  ComplexVector z;                 ///< (V,) as Solver::solve returns it: its area is that in 3D
  std::vector<double> area;        ///< per face of the chart, in 3D
  std::vector<double> log2_scale;  ///< per face, log2 of the root of (area in the plane / area in 3D), within +-16
  std::vector<double> qc;          ///< per face, weighted by area, each triangle's at most 1000
};

/// Solves a chart of `mesh`. Where it cannot be solved, `solved` is false. Throws Cancelled.
TrialMap solve_trial_map(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, const Progress& progress);

/// Maps of the charts of a mesh, shared by the trials in which a chart stays as it is.
using TrialMaps = std::vector<std::shared_ptr<const TrialMap>>;

/// Distortion of several charts together.
struct MapQuality {
  bool solved = true;            ///< all charts are
  double median_log2_scale = 0;  ///< weighted by area
  double within_limit = 1;       ///< fraction of the area whose scale is within a factor of the median
  double scale_variance = 0;     ///< mean of (log2_scale - median)^2, weighted by area
  double mean_qc = 1;            ///< weighted by area
  double area = 0;

  /// One number for both kinds of distortion, 0 for an isometry: the variance of the scale and the excess of the mean
  /// QC, weighted so that either counts alike where an artist would begin to mind (a deviation of 0.5, a QC of 1.05).
  /// Infinite where a chart is not solved.
  double distortion() const;
};

/// `scale_limit` is the factor of within_limit, above 1.
MapQuality map_quality(const TrialMaps& charts, double scale_limit);

}  // namespace spectral_conformal
