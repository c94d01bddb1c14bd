#pragma once

#include <vector>

#include "seams/trial_map.h"

namespace spectral_conformal {

/// Where a cut would lower the distortion of a map: the surroundings of an extremum.
struct DistortedRegion {
  int vertex;     ///< of the mesh
  bool on_loop;   ///< on the loop of a hole, not inside
  double volume;  ///< distortion around the vertex, weighted by area
};

/// The prominent extrema of the log scale relative to its median (field_extrema.h), away from the outer loop: minima,
/// and maxima inside the chart. mesh: the one from which the chart was built.
std::vector<DistortedRegion> scale_extrema(const PolygonMesh& mesh, const TrialMap& mapped, double median_log2_scale);

/// Vertices away from the outer loop with more excess of QC over 1 than their neighbors, summed over their faces by
/// area.
std::vector<DistortedRegion> angle_peaks(const PolygonMesh& mesh, const TrialMap& mapped);

}  // namespace spectral_conformal
