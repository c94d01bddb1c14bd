#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "seams/distorted_regions.h"
#include "seams/piece_seams.h"
#include "seams/separating_cut.h"
#include "seams/trial_map.h"

namespace spectral_conformal {

/// Cuts that may lower the distortion of the maps of a piece's charts, or separate their overlaps; a solve tells
/// whether they do. Cuts include their mirror images if the piece has any (see PieceSeams), and may be empty.
class CutCandidates {
 public:
  struct Region : DistortedRegion {
    int chart;
  };
  enum class Kind { scale, angle };

  /// The maps of the piece with the seams that it has, and their quality together. All must outlive this object.
  CutCandidates(const PieceSeams& seams, const TrialMaps& charts, const MapQuality& quality);

  /// False for the second of two charts that mirror each other: cuts of the first are cuts of both.
  bool is_first_of_mirrored(int chart) const;
  /// The extrema of the scale, or the peaks of the QC, in falling order of volume; of mirrored ones the one on the
  /// positive side, of mirrored charts those of the first.
  std::vector<Region> regions(Kind kind) const;
  /// The cheapest cut from a region to what is cut in `seams`, those of the piece with perhaps more.
  SeamEdges cut_to(const Region& region, const PieceSeams& seams) const;
  /// Makes an island of the surroundings of a region, up to where the scale is the median.
  SeamEdges cut_around(const Region& region) const;
  /// Cuts that may part the sheets of a chart's map that lie on each other; `defective` as defective_faces returns
  /// them.
  std::vector<SeamEdges> cuts_between(int chart, const std::vector<int>& defective) const;
  /// Cuts that part a chart of several faces in any case: its halves, the largest part of the defective faces from the
  /// rest, and one of them.
  std::vector<SeamEdges> cuts_apart(int chart, const std::vector<int>& defective) const;
  /// Makes islands of the defective faces without which the others are none any more (faces_in_the_way.h); empty where
  /// they are more than a fiftieth of the chart's, or a part of them has more than 50 faces.
  SeamEdges cut_out(int chart, const std::vector<int>& defective) const;
  /// The cut through the middle of a chart; empty where it has one face.
  SeamEdges halve(int chart) const;
  /// Cuts through the middle of the charts with most distortion.
  std::vector<SeamEdges> halves() const;
  /// Cuts through the middle of all charts that are not solved, together.
  SeamEdges halve_unsolved() const;

 private:
  bool is_self_mirrored(int chart) const;
  SeamEdges cut_between_ends(int chart, const std::vector<int>& some) const;
  /// Made once per chart.
  const SeparableFaces& separable(int chart) const;

  const PieceSeams& seams_;
  const TrialMaps& charts_;
  const MapQuality& quality_;
  std::vector<int> chart_of_face_;                                        ///< per face of the piece
  mutable std::vector<std::mutex> mutexes_;                               ///< per chart, of separable_
  mutable std::vector<std::unique_ptr<const SeparableFaces>> separable_;  ///< per chart, as far as it was asked for
};

}  // namespace spectral_conformal
