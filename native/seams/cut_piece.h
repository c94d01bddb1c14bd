#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "seams/known_maps.h"
#include "seams/piece_seams.h"
#include "seams/seam_functional.h"
#include "seams/trial_map.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// A change of the seams of a piece, and the maps that it leads to.
struct SeamTrial {
  SeamEdges added;
  SeamEdges removed;
  TrialMaps charts;
  MapQuality quality;
  double value = 0;  ///< of the functional
};

/// A piece with its seams, the maps of its charts, and the value of the functional. It solves trials of other seams,
/// each chart of them once, and takes the one that the search chooses.
class CutPiece {
 public:
  /// Vertices of the maps that are kept for later trials: some hundred megabytes.
  static constexpr std::int64_t max_remembered = 400000;

  /// `options` must outlive this object. `mesh_area` is that of the whole mesh.
  CutPiece(PieceSeams seams, const SeamSuggestionOptions& options, double mesh_area);

  /// Solves all charts, those that are `known` excepted. Throws Cancelled.
  void solve(const KnownMaps& known, const Progress& progress);
  /// Solves the charts again that have no map, now with the fallbacks of SolveOptions, as all trials from now on.
  void allow_fallbacks(const Progress& progress);
  bool has_fallbacks() const { return has_fallbacks_; }

  /// Solves the charts that a change makes, as far as they are not `known`. Safe to call by several threads at once.
  SeamTrial attempt(SeamEdges added, SeamEdges removed, const KnownMaps& known, const Progress& progress) const;
  /// The trials of several changes, in parallel; their maps are remembered.
  std::vector<SeamTrial> attempt_all(const std::vector<std::array<SeamEdges, 2>>& added_and_removed,
                                     const Progress& progress);
  /// Makes the trial's change.
  void take(SeamTrial&& trial);
  /// Whether the charts of a trial that are not those of this piece have maps without flips and overlaps.
  bool is_sound(const SeamTrial& trial) const;
  bool is_known_sound(const std::shared_ptr<const TrialMap>& map) const { return sound_.contains(map); }
  void set_sound(const KnownMaps& maps) { sound_ = maps; }
  bool makes_islands(const SeamTrial& trial) const { return trial.charts.size() > charts_.size(); }
  /// Keeps maps of trials until the second call of forget_old_trials from now on, as far as they are few.
  void remember(const TrialMaps& tried);
  void forget_old_trials();

  const PieceSeams& seams() const { return seams_; }
  const TrialMaps& charts() const { return charts_; }
  bool is_current(const std::shared_ptr<const TrialMap>& map) const { return current_.contains(map); }
  const MapQuality& quality() const { return quality_; }
  const SeamFunctional& functional() const { return functional_; }
  double value() const { return value_; }
  /// Vertices of all charts that were solved so far, which the time of the search goes with.
  std::int64_t solved_vertices() const { return solved_vertices_; }

 private:
  TrialMaps map_charts(const SeamEdges& added, const SeamEdges& removed, const KnownMaps& known,
                       const Progress& progress) const;
  std::vector<int> faces_beside(const SeamEdges& added, const SeamEdges& removed, TrialMaps& others) const;

  PieceSeams seams_;
  const SeamSuggestionOptions& options_;
  SeamFunctional functional_;
  TrialMaps charts_;
  KnownMaps current_;               ///< charts_
  std::vector<int> chart_of_face_;  ///< per face of the piece; -1 where it is in none
  MapQuality quality_;
  double value_ = 0;
  KnownMaps sound_;   ///< maps known to be without defects
  KnownMaps recent_;  ///< of trials before forget_old_trials, and since
  KnownMaps fresh_;
  bool has_fallbacks_ = false;
  mutable std::atomic<std::int64_t> solved_vertices_{0};  ///< by several threads at once
};

/// Runs work(0 ... n - 1) on as many threads as trials may take.
void try_in_parallel(std::size_t n, const std::function<void(int, const Progress&)>& work, const Progress& progress);

}  // namespace spectral_conformal
