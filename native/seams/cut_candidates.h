#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "seams/cut_piece.h"
#include "seams/distorted_regions.h"
#include "seams/separating_cut.h"

namespace spectral_conformal {

/// Cuts that may lower the distortion of a piece's charts or separate their overlaps; only a solve shows whether they
/// do. Cuts include their mirror images if the piece is symmetric (PieceSeams::is_symmetric), and may be empty.
class CutCandidates {
 public:
  struct Region : DistortedRegion {
    int chart;
  };
  enum class Kind { scale, angle };

  /// `piece` is solved, must outlive this object and must not change.
  explicit CutCandidates(const CutPiece& piece);

  /// False for the second of two charts that mirror each other: cuts of the first cut both.
  bool is_first_of_mirrored(int chart) const;
  /// The extrema of the scale, or the peaks of QC, largest volume first. Of two mirrored ones, only the one on the
  /// positive side or in the first chart. Found once per kind; two threads may ask for different kinds at once.
  const std::vector<Region>& regions(Kind kind) const;
  /// The cheapest cut from a region to a seam or the boundary. `seams`: those of the piece, perhaps with more.
  SeamEdges cut_to(const Region& region, const PieceSeams& seams) const;
  /// PieceSeams::loop_through a region, within its chart.
  SeamEdges loop_through(const Region& region, std::size_t which) const;
  /// Makes an island of a region's surroundings, up to where the scale is the median.
  SeamEdges cut_around(const Region& region) const;
  /// Cuts that may separate the overlapping sheets of a chart's map. defective: see defective_faces.
  std::vector<SeamEdges> cuts_between(int chart, const std::vector<int>& defective) const;
  /// Cuts that always split a chart of several faces: in halves, the largest part of the defective faces from the rest,
  /// and one of these faces from the rest.
  std::vector<SeamEdges> cuts_apart(int chart, const std::vector<int>& defective) const;
  /// Makes islands of enough defective faces to leave the rest without defects (faces_in_the_way.h). Empty if more than
  /// a fiftieth of the chart's faces are defective, or a connected part of these has more than 50 faces.
  SeamEdges cut_out(int chart, const std::vector<int>& defective) const;
  /// The cut through the middle of a chart; empty if it has one face.
  SeamEdges halve(int chart) const;
  /// The few charts with the most distortion, of several faces, worst first. Of two mirrored ones, the first.
  std::vector<int> most_distorted() const;
  /// Cuts through the middle of charts.
  std::vector<SeamEdges> halves(const std::vector<int>& charts) const;
  /// One cut through the middle of every unsolved chart.
  SeamEdges halve_unsolved() const;

 private:
  bool is_self_mirrored(int chart) const;
  std::vector<Region> found_regions(Kind kind) const;
  SeamEdges cut_between_ends(int chart, const std::vector<int>& some) const;
  /// Computed once per chart.
  const SeparableFaces& separable(int chart) const;

  const PieceSeams& seams_;
  const TrialMaps& charts_;
  const MapQuality& quality_;
  const std::vector<int>& chart_of_face_;
  mutable std::array<std::optional<std::vector<Region>>, 2> regions_;     ///< per kind
  mutable std::vector<std::mutex> mutexes_;                               ///< per chart, for separable_
  mutable std::vector<std::unique_ptr<const SeparableFaces>> separable_;  ///< per chart, null until needed
};

}  // namespace spectral_conformal
