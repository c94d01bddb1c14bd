#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "seams/cut_candidates.h"
#include "seams/known_maps.h"
#include "seams/piece_seams.h"
#include "seams/seam_functional.h"
#include "seams/trial_map.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The greedy search for the cuts of one piece. It solves the proposals of CutCandidates and takes a cut if the maps
/// gain enough for its length; each step makes the cuts with the highest gain per length. When the maps are good
/// enough, or no cut gains any more, it splits charts that overlap themselves or have flipped faces, until none are
/// left. In the end it sews up seams that the maps can do without.
class Cutter {
 public:
  /// A trial of a large mesh takes hundreds of megabytes.
  static constexpr unsigned max_threads = 4;

  /// Where in the search a piece is: it may stand for a finer one, and its seams may come from a coarser one.
  struct Stage {
    int n_vertices = 0;     ///< of the finest piece, which the number of trials is chosen by
    bool refined = false;   ///< the seams were found on a coarser piece
    bool is_large = false;  ///< no more than has to be is solved for at the finer levels
    double mesh_area = 0;   ///< of the whole mesh, which SeamSuggestionOptions::qc_gain is for; 0: of the piece alone
  };

  /// `seams` are open already (PieceSeams::open). `options` must outlive this object.
  Cutter(PieceSeams seams, const SeamSuggestionOptions& options);
  Cutter(PieceSeams seams, const SeamSuggestionOptions& options, const Stage& stage);

  /// Solves the piece with the seams that it has. Throws Cancelled.
  void solve(const Progress& progress);
  /// The next cuts, not longer than `longest` together; they are added to seams(). Empty, and finished() from then on,
  /// where there are none; what was sewn up is then no longer in seams(). Throws Cancelled.
  SeamEdges step(double longest, const Progress& progress);

  /// For seams that were found in another way, instead of step(): parts charts with defects, then takes back chains of
  /// seams as long as that lowers the functional. Throws Cancelled.
  void settle(const SeamFunctional& functional, const Progress& progress);
  /// Whether no chart has defects.
  bool is_sound() const;

  bool finished() const { return finished_; }
  const PieceSeams& seams() const { return seams_; }
  const MapQuality& quality() const { return quality_; }
  /// The maps of the charts that seams() make.
  const TrialMaps& charts() const { return charts_; }
  /// Vertices of all charts that were solved so far, which the time of the search goes with.
  std::int64_t solved_vertices() const { return solved_vertices_; }

 private:
  /// A cut that is to be tried.
  struct Proposal {
    SeamEdges cut;
    bool may_part = false;  ///< whether it may make islands
    int chart = -1;         ///< that it is in, -1 for several
  };
  struct Trial {
    SeamEdges cut;
    TrialMaps charts;
    MapQuality quality;
  };
  /// What parts the defects of one chart.
  struct Parting {
    SeamEdges cut;          ///< empty where it would be too long
    TrialMaps charts;       ///< the maps of it that are not there yet
    TrialMaps tried;        ///< those of its trials, as far as they are few
    std::int64_t room = 0;  ///< vertices of maps that these still take
  };
  /// Faces of the piece that cover others or are flipped, ascending, and their area.
  struct Defects {
    std::vector<int> faces;
    double extent = 0;
  };
  /// A face of the piece that covers others or is flipped.
  struct DefectiveFace {
    int face;
    double extent;
  };
  /// A chart with defects, and what a cut that parts them may be.
  struct DefectiveChart {
    std::vector<DefectiveFace> faces;
    double extent;          ///< of these
    double max_distortion;  ///< of the maps
    double longest;
  };
  /// A cut that removes some of a chart's defects, and these.
  struct PartCut {
    SeamEdges cut;
    std::vector<DefectiveFace> removed;
  };
  /// A cut that gained nothing in a chart, which is kept so that no other can take its place in memory.
  using Futile = std::pair<std::shared_ptr<const TrialMap>, SeamEdges>;

  void solve(const KnownMaps& known, const Progress& progress);
  void allow_fallbacks(const Progress& progress);
  bool good_enough() const;
  bool good_enough_but_for_qc() const;
  bool is_small() const;
  bool hurries() const;  ///< at the finer levels of a large piece
  TrialMaps map_charts(const std::vector<std::array<int, 2>>& seams, const SeamEdges& changed, const KnownMaps& known,
                       const Progress& progress) const;
  void take_maps(TrialMaps&& charts, const MapQuality& quality);
  void remember(const TrialMaps& tried);
  void remember(const std::vector<Trial>& trials);
  CutCandidates candidates() const { return {seams_, charts_, quality_}; }

  Trial attempt(SeamEdges cut, const KnownMaps& known, const Progress& progress) const;
  std::vector<Trial> attempt_all(const std::vector<Proposal>& proposals, const Progress& progress);
  bool makes_islands(const Trial& trial) const;
  double price(const SeamEdges& cut) const;
  double excess(const MapQuality& quality) const;
  bool only_qc_counts() const;
  double least_qc_gain(const SeamEdges& cut) const;
  double gain(const Trial& trial) const;
  bool may_gain_later(const Trial& halved) const;
  bool is_tried(const Proposal& proposal) const;
  std::vector<Trial> gaining(std::vector<Proposal> proposals, double longest, const Progress& progress);
  SeamEdges accept_best(std::vector<Trial>&& trials, double longest, const Progress& progress);
  SeamEdges accept(Trial&& trial);

  SeamEdges cut_distortion(double longest, const Progress& progress);
  bool price_by_qc();
  SeamEdges cut_to_all(double longest, const Progress& progress);
  SeamEdges best_cut(double longest, const Progress& progress);
  SeamEdges split_in_half(double longest, const Progress& progress);
  SeamEdges part_defects(double longest, const Progress& progress);
  Parting part_chart(const CutCandidates& candidates, int chart, const std::vector<int>& faces, double longest,
                     std::int64_t remembered, const Progress& progress) const;
  SeamEdges part_large_chart(const CutCandidates& candidates, int chart, const std::vector<int>& faces,
                             double longest) const;
  DefectiveChart defective_chart(int chart, const std::vector<int>& faces, double longest) const;
  Trial best_parting(const DefectiveChart& chart, std::vector<SeamEdges>&& cuts, bool at_any_price,
                     std::vector<PartCut>& some, Parting& parting, const Progress& progress) const;
  static PartCut part_cut(const DefectiveChart& chart, const SeamEdges& cut, const Defects& left);
  Trial part_together(const DefectiveChart& chart, const std::vector<PartCut>& some, const Progress& progress) const;
  Defects defects_left(const Trial& trial, double unsolved) const;
  SeamEdges cut_together(const std::vector<PartCut>& cuts) const;
  SeamEdges blind_cut(double longest, const Progress& progress);
  SeamEdges halve_unsolved(double longest, const Progress& progress);
  int max_blind() const;
  int max_chosen_vertices() const;
  bool is_patience_spent() const;
  bool is_sewable(const Trial& trial) const;
  std::int64_t vertices_beside(const SeamEdges& edges) const;
  void sew(const Progress& progress);

  PieceSeams seams_;
  const SeamSuggestionOptions& options_;
  Stage stage_;
  bool changed_;  ///< seams are not those of a coarser piece
  TrialMaps charts_;
  KnownMaps current_;               ///< charts_
  std::vector<int> chart_of_face_;  ///< of charts_, per face of the piece; -1 where a face is in none
  MapQuality quality_;
  KnownMaps recent_;  ///< of trials of the last step and this one that were not accepted, as far as they are few
  KnownMaps fresh_;
  std::vector<Futile> futile_;
  KnownMaps sound_;  ///< those of charts_ that are known to be without defects
  bool finished_ = false;
  bool exhausted_ = false;    ///< no cut gains any more
  bool cones_tried_ = false;  ///< also where they were on a coarser piece
  int losses_together_ = 0;
  int blind_cuts_ = 0;
  bool fallbacks_ = false;  ///< are allowed to trial maps
  bool is_energy_given_up_ = false;
  int losing_splits_ = 0;
  int partings_ = 0;                                      ///< steps that part defects
  mutable std::atomic<std::int64_t> solved_vertices_{0};  ///< by several threads at once
};

}  // namespace spectral_conformal
