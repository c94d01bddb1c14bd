#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "seams/piece_seams.h"
#include "seams/seam_functional.h"
#include "seams/trial_map.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// A change of a piece's seams, and the resulting maps.
struct SeamTrial {
  SeamEdges added;
  SeamEdges removed;
  TrialMaps charts;
  MapQuality quality;
  double value = 0;        ///< of the functional
  double seams_value = 0;  ///< its terms for seams and islands
};

/// A piece with its seams, the maps of its charts, and the value of the functional. It solves trials of other seams,
/// each chart once, and applies the trial that the search chooses.
class CutPiece {
 public:
  /// `options` must outlive this object. `mesh_area` is that of the whole mesh; 0: of the piece.
  CutPiece(PieceSeams seams, const SeamSuggestionOptions& options, double mesh_area);

  /// Rates the seams by other options, which must outlive this object. Precondition: all charts are solved.
  void rate_by(const SeamSuggestionOptions& options);
  /// Rates the seams with this side of the sheet, too. Precondition: all charts are solved.
  void rate_by(double sheet_side);
  /// Rates turns by this least price, too (SeamGraph::set_least_turn). Precondition: all charts are solved.
  void rate_turns(double least);
  /// Counts open rings from now on (PieceSeams::open_rings): while seams grow, most rings are cut in part.
  void count_rings();
  /// Solves all charts except the `known` ones. Throws Cancelled.
  void solve(const KnownMaps& known, const Progress& progress);
  /// Solves the charts without a map again, with the fallbacks of SolveOptions; later trials use these, too. Throws
  /// Cancelled.
  void allow_fallbacks(const Progress& progress);
  bool has_fallbacks() const { return has_fallbacks_; }

  /// Solves the charts that a change makes, except the `known` ones. Several threads may call it at once. Throws
  /// Cancelled.
  SeamTrial attempt(SeamEdges added, SeamEdges removed, const KnownMaps& known, const Progress& progress) const;
  /// Tries several changes in parallel. Throws Cancelled.
  std::vector<SeamTrial> attempt_all(const std::vector<std::array<SeamEdges, 2>>& added_and_removed,
                                     const KnownMaps& known, const Progress& progress) const;
  /// Makes the change of a trial.
  void apply(SeamTrial&& trial);
  /// Whether a trial has less seams, by their price, and exceeds no limit by more than now.
  bool shortens(const SeamTrial& trial) const;
  /// Whether the charts that a trial changes have maps without flips and overlaps.
  bool is_sound(const SeamTrial& trial) const;
  bool is_known_sound(const std::shared_ptr<const TrialMap>& map) const { return sound_.count(map) > 0; }
  void set_sound(const KnownMaps& maps) { sound_ = maps; }
  /// The value if a change of the seams removed all distortion of the charts beside it, made no islands, and left the
  /// median scale of the piece as it is. Precondition: all charts are solved.
  double least_value(const SeamEdges& added, const SeamEdges& removed) const;
  /// The same for any cut of one chart, which costs nothing.
  double least_value(int chart) const;
  bool makes_islands(const SeamTrial& trial) const { return trial.charts.size() > charts_.size(); }

  const PieceSeams& seams() const { return seams_; }
  const TrialMaps& charts() const { return charts_; }
  /// (F,) per face of the piece, -1 if it is in none.
  const std::vector<int>& chart_of_face() const { return chart_of_face_; }
  bool is_current(const std::shared_ptr<const TrialMap>& map) const { return current_.count(map) > 0; }
  const MapQuality& quality() const { return quality_; }
  /// What an island costs, as the cost of a seam.
  double cost_of_island() const;
  const SeamFunctional& functional() const { return functional_; }
  double value() const { return value_; }
  /// The terms of the value for seams and islands.
  double seams_value() const { return seams_value_; }
  /// Vertices of all charts solved so far: a measure of the search time.
  std::int64_t solved_vertices() const { return solved_vertices_; }

 private:
  TrialMaps map_charts(const SeamEdges& added, const SeamEdges& removed, const KnownMaps& known,
                       const Progress& progress) const;
  std::vector<char> charts_beside(const SeamEdges& added, const SeamEdges& removed) const;
  double seams_cost(const SeamEdges& added, const SeamEdges& removed) const;
  double open_rings(const SeamEdges& added, const SeamEdges& removed) const;
  double least_value(const std::vector<char>& is_changed, const SeamEdges& added, const SeamEdges& removed) const;
  std::vector<int> faces_beside(const SeamEdges& added, const SeamEdges& removed, TrialMaps& others) const;

  PieceSeams seams_;
  const SeamSuggestionOptions* options_;
  SeamFunctional functional_;
  bool counts_rings_ = false;
  TrialMaps charts_;
  KnownMaps current_;  ///< the maps in charts_
  std::vector<int> chart_of_face_;
  std::vector<double> squared_excess_;  ///< per chart, see squared_excess; empty without maps
  MapQuality quality_;
  double value_ = 0;
  double seams_value_ = 0;
  KnownMaps sound_;  ///< maps known to be without defects
  bool has_fallbacks_ = false;
  mutable std::atomic<std::int64_t> solved_vertices_{0};  ///< several threads add to it
};

/// Runs work(0 ... n - 1) on at most tries_at_once threads. Throws Cancelled.
void try_in_parallel(std::size_t n, const std::function<void(int, const Progress&)>& work, const Progress& progress);

}  // namespace spectral_conformal
