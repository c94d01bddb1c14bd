#pragma once

#include <cstddef>

#include "seams/trial_map.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The price of an island, as the length of a seam over the root of the mesh's area: a new island must save more than a
/// short seam.
constexpr double island_price = 0.05;
/// The price of a ring that is cut but for a narrow hinge, in islands. Such a hinge saves an island and little seam, so
/// that a cap would hang on its cylinder by one edge.
constexpr double islands_per_ring = 4;

/// Rates a choice of seams in a piece; lower is better, and every decision of the search lowers it:
///
///     F = |E - 4| / (E_max - 4) + (sum of c_e + sum of t_v + sqrt(A_M) (n / 20 + r / 5)) / sqrt(A) + G + S
///
/// |E - 4| is the root mean square, over the area A of the piece, of the faces' symmetric Dirichlet energies in excess
/// of an isometry's (MapQuality::rms_excess). It lies between their mean and their maximum; with the 4-norm, the search
/// chased a few faces that no cut helps. E_max is SeamSuggestionOptions::energy_limit, the exchange rate between
/// distortion and seams: the allowed distortion costs as much as a seam of length sqrt(A). c_e are the costs of the new
/// seam edges, their lengths times their prices (SeamGraph::Edge::cost), t_v those of its turns (SeamGraph::turning). n
/// is the number of islands; each costs a twentieth of a seam as long as the root of the whole mesh's area A_M, on
/// whose sheet it takes a margin, however small the piece. r counts the rings that are cut but for a narrow hinge
/// (PieceSeams::open_rings); each costs as much as four islands. G is the price of exceeding the limits of the
/// options. S is what the longer sides of the islands' maps have beyond the side of the sheet, over sqrt(A): it costs
/// as a seam of that length, so long strips are parted. The caller excludes flips and overlaps.
class SeamFunctional {
 public:
  /// `options` must outlive this object. `size_in_mesh`: sqrt(A / A_M); 1 for a piece that is the whole mesh.
  explicit SeamFunctional(const SeamSuggestionOptions& options, double size_in_mesh = 1)
      : options_(&options), size_in_mesh_(size_in_mesh) {}

  /// Goes by other options from now on, which must outlive this object.
  void set_options(const SeamSuggestionOptions& options) { options_ = &options; }
  /// Islands whose maps are longer cost more from now on.
  void set_sheet_side(double side) { sheet_side_ = side; }
  /// `cost` is the sum of c_e, t_v and beyond_sheet(), `open_rings` is r; `quality` rates the maps of all islands
  /// together. Infinite if an island has no map.
  double operator()(double cost, double open_rings, std::size_t n_islands, const MapQuality& quality) const;
  /// What the longer sides of these maps have beyond the side of the sheet, together.
  double beyond_sheet(const TrialMaps& charts) const;
  /// Of one island, as the style of the options has it, in roots of the piece's area.
  double price_of_island() const;
  /// The functional without the terms for seams and islands.
  double distortion(const MapQuality& quality) const;
  /// G: what exceeds the limits, at its price; 0 if they are met.
  double beyond_limits(const MapQuality& quality) const;
  /// Whether there is more distortion than this share of what the limits allow: of the energy above 4, and of the mean
  /// QC above 1.
  bool exceeds_limits(const MapQuality& quality, double share = 1) const;

 private:
  const SeamSuggestionOptions* options_;
  double size_in_mesh_;
  double sheet_side_ = infinity;
};

}  // namespace spectral_conformal
