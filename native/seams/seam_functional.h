#pragma once

#include <vector>

#include "seams/seam_graph.h"
#include "seams/trial_map.h"

namespace spectral_conformal {

/// What a choice of seams in a piece is judged by, less being better:
///
///     F = |E - 4| / (E_max - 4) + sum of p_e l_e / sqrt(A) + n / 20
///
/// |E - 4| is the 4-norm, a mean over the area A of the piece, of the faces' symmetric Dirichlet energies above that of
/// an isometry (MapQuality::energy says how these are bounded): between their mean and the worst of them. E_max is
/// SeamSuggestionOptions::energy_limit, the rate at which distortion is exchanged for seams: as much as is allowed
/// costs what a seam of the length sqrt(A) does. p_e l_e are the prices and lengths of the new seams' edges
/// (seam_price.h), n is the number of islands: each costs a twentieth of such a seam. Flips and overlaps are for the
/// caller to exclude.
class SeamFunctional {
 public:
  /// price per edge of the graph, which must outlive this object.
  SeamFunctional(const SeamGraph& graph, std::vector<double> price, double energy_limit)
      : graph_(graph), price_(std::move(price)), energy_limit_(energy_limit) {}

  /// `seams` are edges of the graph, `charts` the maps of what they leave connected; infinite where one has no map.
  double operator()(const std::vector<int>& seams, const TrialMaps& charts) const;
  /// Sum of p_e l_e.
  double price(const std::vector<int>& seams) const;
  const std::vector<double>& prices() const { return price_; }

 private:
  const SeamGraph& graph_;
  std::vector<double> price_;
  double energy_limit_;
};

}  // namespace spectral_conformal
