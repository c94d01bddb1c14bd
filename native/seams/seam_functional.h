#pragma once

#include <cstddef>

#include "seams/trial_map.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// Of an island, as a fraction of the root of the area: parting must save more than one short seam.
constexpr double island_price = 0.05;

/// The functional that rates a choice of seams in a piece; lower is better, and every decision of the search lowers it:
///
///     F = |E - 4| / (E_max - 4) + sum of c_e / sqrt(A) + n / 20 + G
///
/// |E - 4| is the root mean square, over the area A of the piece, of the faces' symmetric Dirichlet energies above that
/// of an isometry (MapQuality::rms_excess). It lies between their mean and their maximum; with the 4-norm the
/// search followed a few faces that no cut helps. E_max is
/// SeamSuggestionOptions::energy_limit, the exchange rate between distortion and seams: the allowed distortion costs as
/// much as a seam of length sqrt(A). c_e are the costs of the new seam edges, their lengths times their prices
/// (SeamGraph::Edge::cost). n is the number of islands; each costs a twentieth of such a seam. G is the price of what
/// exceeds the limits of the options. The caller excludes flips and overlaps.
class SeamFunctional {
 public:
  /// `options` must outlive this object. `mesh_area` is that of the whole mesh, which options.qc_gain is for; 0: of the
  /// piece alone.
  SeamFunctional(const SeamSuggestionOptions& options, double mesh_area) : options_(options), mesh_area_(mesh_area) {}

  /// `cost` is the sum of c_e, and `quality` that of the maps of the islands; infinite where one has no map.
  double operator()(double cost, std::size_t n_islands, const MapQuality& quality) const;
  /// What it counts beside the cost of seams and the number of islands.
  double distortion(const MapQuality& quality) const;
  /// Whether a limit is exceeded.
  bool exceeds_limits(const MapQuality& quality) const;

 private:
  double beyond_limits(const MapQuality& quality) const;

  const SeamSuggestionOptions& options_;
  double mesh_area_;
};

}  // namespace spectral_conformal
