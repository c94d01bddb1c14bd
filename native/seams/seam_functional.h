#pragma once

#include <vector>

#include "seams/seam_graph.h"
#include "seams/trial_map.h"

namespace spectral_conformal {

/// The functional that rates a choice of seams in a piece; lower is better:
///
///     F = |E - 4| / (E_max - 4) + sum of p_e l_e / sqrt(A) + n / 20
///
/// |E - 4| is the 4-norm, as a mean over the area A of the piece, of the faces' symmetric Dirichlet energies above that
/// of an isometry (bounded as in MapQuality::energy). It lies between their mean and their maximum. E_max is
/// SeamSuggestionOptions::energy_limit, the exchange rate between distortion and seams: the allowed distortion costs as
/// much as a seam of length sqrt(A). p_e and l_e are the prices and lengths of the new seam edges (seam_price.h). n is
/// the number of islands; each costs a twentieth of such a seam. The caller excludes flips and overlaps.
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
