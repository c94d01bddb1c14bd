#pragma once

#include <vector>

#include "seams/cut_candidates.h"
#include "seams/piece_seams.h"
#include "seams/trial_map.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The greedy search for the cuts of one piece: what CutCandidates proposes is solved, and taken if the maps gain
/// enough for the length of the cut. Each step makes the cuts whose gain for their length is highest.
class Cutter {
 public:
  /// `seams` are open already (PieceSeams::open). `options` must outlive this object.
  Cutter(PieceSeams seams, const SeamSuggestionOptions& options);

  /// Solves the piece with the seams that it has. Throws Cancelled.
  void solve(const Progress& progress);
  /// The next cut that lowers the distortion, or overlaps, and is not longer than `longest`; it is added to seams().
  /// Empty, and finished() from then on, where there is none or the map is good enough. Throws Cancelled.
  SeamEdges step(double longest, const Progress& progress);

  bool finished() const { return finished_; }
  const PieceSeams& seams() const { return seams_; }
  const MapQuality& quality() const { return quality_; }

 private:
  struct Trial {
    SeamEdges cut;
    TrialMaps charts;
    MapQuality quality;
  };

  bool good_enough() const;
  bool is_small() const;
  TrialMaps map_charts(const SeamEdges& more, const Progress& progress) const;
  CutCandidates candidates() const { return {seams_, charts_, quality_}; }

  Trial attempt(SeamEdges cut, const Progress& progress) const;
  bool makes_islands(const Trial& trial) const;
  double price(const Trial& trial) const;
  double gain(const Trial& trial) const;
  void try_cut(SeamEdges cut, bool islands_allowed, double longest, const Progress& progress,
               std::vector<Trial>& trials) const;
  SeamEdges accept_best(std::vector<Trial>&& trials, double longest, const Progress& progress);
  SeamEdges accept(Trial&& trial);

  SeamEdges cut_to_all(double longest, const Progress& progress);
  SeamEdges cut_between_overlaps(double longest, const Progress& progress);
  SeamEdges best_cut(double longest, const Progress& progress);
  SeamEdges blind_cut();

  PieceSeams seams_;
  const SeamSuggestionOptions& options_;
  TrialMaps charts_;
  MapQuality quality_;
  bool finished_ = false;
  int blind_cuts_ = 0;
};

}  // namespace spectral_conformal
