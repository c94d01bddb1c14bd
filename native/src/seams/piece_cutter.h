#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "seams/distorted_regions.h"
#include "seams/piece_seams.h"
#include "seams/trial_map.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct SeamSuggestionOptions {
  double max_length =
      std::numeric_limits<double>::infinity();  ///< of all new seams together, in units of the positions
  double scale_limit = 2;  ///< a factor above 1: enough when 95 % of the area has a scale within it of the median
  double qc_limit = 1.05;  ///< enough when the mean QC, weighted by area, is not above it; at least 1
  PatchOptions map;        ///< of the maps whose distortion counts
};

/// Finds cut after cut for one piece, each of which is solved before it is taken.
class PieceCutter {
 public:
  /// `seams` are open already (PieceSeams::open). `options` must outlive this object.
  PieceCutter(PieceSeams seams, const SeamSuggestionOptions& options);

  /// Solves the piece with the seams that it has. Throws Cancelled.
  void solve(const Progress& progress);
  /// The next cut that lowers the distortion, or overlaps, and is not longer than `longest`; it is added to seams().
  /// Empty, and finished() from then on, where there is none or the map is good enough. Throws Cancelled.
  SeamEdges step(double longest, const Progress& progress);

  bool finished() const { return finished_; }
  const PieceSeams& seams() const { return seams_; }
  const MapQuality& quality() const { return quality_; }

 private:
  using MappedCharts = std::vector<std::shared_ptr<const MappedChart>>;
  struct Place : DistortedPlace {
    int chart;
  };
  struct Trial {
    SeamEdges cut;
    MappedCharts charts;
    MapQuality quality;
  };
  enum class Kind { scale, angle };

  bool good_enough() const;
  bool is_small() const;
  MappedCharts map_charts(const SeamEdges& more, const Progress& progress) const;
  std::vector<int> chart_of_face() const;
  std::vector<Place> places(Kind kind, const std::vector<int>& chart_of_face) const;
  SeamEdges cut_to(const Place& place, const std::vector<int>& chart_of_face) const;
  SeamEdges cut_around(const Place& place, const std::vector<int>& chart_of_face) const;
  std::vector<SeamEdges> cuts_between(int chart, const std::vector<int>& overlapping,
                                      const std::vector<int>& chart_of_face) const;
  std::vector<SeamEdges> halves(const std::vector<int>& chart_of_face) const;
  SeparableFaces separable(int chart) const;

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
  MappedCharts charts_;
  MapQuality quality_;
  bool finished_ = false;
  int blind_cuts_ = 0;
};

}  // namespace spectral_conformal
