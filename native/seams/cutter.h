#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "seams/cut_candidates.h"
#include "seams/cut_piece.h"
#include "seams/seam_functional.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// Searches for the cuts of one piece that lower the functional (seam_functional.h). It solves the proposals of
/// CutCandidates and makes the cuts that lower it most, until the limits are met. Then, or when none does, it parts
/// charts with overlaps or flipped faces (defect_parting.h) until none are left. Finally it takes back seams that do
/// not pay (seam_settling.h), and halves islands that are too long for the sheet. For the shortest seams it cuts
/// further than the limits, and takes back what they allow.
class Cutter {
 public:
  /// The level of the piece: it may stand for a finer one, and its seams may come from a coarser one.
  struct Stage {
    int n_vertices = 0;            ///< of the finest piece; determines the number of trials
    bool refined = false;          ///< the seams were found on a coarser piece, or in another way
    bool is_large = false;         ///< at the finer levels, only what is necessary is solved
    double mesh_area = 0;          ///< of the whole mesh; 0: the area of the piece
    bool whole_loops = false;      ///< whether edge loops are proposed as wholes
    double sheet_side = infinity;  ///< see SeamFunctional
    double least_turn = 0;         ///< of seams once settled, see SeamGraph::set_least_turn
  };

  /// Precondition: with `seams`, no handle or closed surface is left (PieceSeams::open). `options` must outlive this
  /// object.
  Cutter(PieceSeams seams, const SeamSuggestionOptions& options, const Stage& stage);

  /// Solves the piece with its present seams. Throws Cancelled.
  void solve(const Progress& progress) { piece_.solve({}, progress); }
  /// Adds the next cuts to seams(), together not longer than `longest`, and returns them. If there are none, it returns
  /// nothing and is finished(). Throws Cancelled.
  SeamEdges cut(double longest, const Progress& progress);
  /// After the last cut(): takes seams back, if there are new ones, and halves strips. Throws Cancelled.
  void conclude(double longest, const Progress& progress);
  /// For seams found in another way: parts charts with defects, takes seams back, and halves strips. Throws Cancelled.
  void settle(const Progress& progress);
  /// Cuts rings whole that are cut but for a narrow hinge, where that lowers the functional. Throws Cancelled.
  void complete_rings(const Progress& progress);
  /// Whether all charts are solved, and the maps exceed the limits of some options.
  bool exceeds(const SeamSuggestionOptions& limits) const;
  /// Searches by other limits from now on; `options` must outlive this object.
  void set_options(const SeamSuggestionOptions& options);
  /// Cuts that lower the functional, while it exceeds the limits. Takes nothing back. Throws Cancelled.
  SeamEdges extend(const Progress& progress) { return grows() ? grow(infinity, progress) : SeamEdges{}; }
  /// Cuts that part charts with defects, where that is possible. Throws Cancelled.
  SeamEdges part_defects(double longest, const Progress& progress);
  /// Whether no chart has defects.
  bool is_sound() const;

  bool finished() const { return finished_; }
  const PieceSeams& seams() const { return piece_.seams(); }
  const MapQuality& quality() const { return piece_.quality(); }
  /// The value of the functional.
  double value() const { return piece_.value(); }
  /// Its terms for seams and islands.
  double seams_value() const { return piece_.seams_value(); }
  /// What the search wants least in the end: the value; for the shortest seams, without the distortion within the
  /// limits. Infinite with defects.
  double rating() const;
  /// The maps of the charts between seams().
  const TrialMaps& charts() const { return piece_.charts(); }
  /// Vertices of all charts solved so far: a measure of the search time.
  std::int64_t solved_vertices() const { return piece_.solved_vertices(); }

 private:
  /// A cut to try.
  struct Proposal {
    SeamEdges cut;
    bool may_part = false;  ///< whether it may make islands
    int chart = -1;         ///< in which it lies; -1 for several
  };
  /// A cut that gained nothing, and the map of its chart, kept so that no other map gets its address.
  using Futile = std::pair<std::shared_ptr<const TrialMap>, SeamEdges>;

  /// At the finer levels of a large piece.
  bool skips_optional_trials() const { return stage_.refined && stage_.is_large; }
  bool is_copy() const { return seams().graph().n_vertices() < stage_.n_vertices; }
  bool grows() const;
  SeamEdges accept(SeamTrial&& trial);
  void remember(const SeamTrial& trial);
  bool is_tried(const Proposal& proposal) const;
  /// Whether this value is lower than that of the seams now, by the price of an island or more.
  bool gains(double value) const { return value < piece_.value() - island_price; }
  std::vector<SeamTrial> gaining(std::vector<Proposal> proposals, double longest, const Progress& progress);
  SeamTrial together(const std::vector<SeamTrial>& trials, KnownMaps known, double longest, const Progress& progress);
  SeamEdges accept_best(std::vector<SeamTrial>&& trials, double longest, const Progress& progress);

  SeamEdges grow(double longest, const Progress& progress);
  SeamEdges cut_to_all(const CutCandidates& candidates, double longest, const Progress& progress);
  SeamEdges best_cut(const CutCandidates& candidates, double longest, const Progress& progress);
  SeamEdges split_in_half(const CutCandidates& candidates, double longest, const Progress& progress);
  std::vector<SeamTrial> gaining_halves(const CutCandidates& candidates, const std::vector<int>& charts, double longest,
                                        const Progress& progress);
  SeamEdges accept_lowest(std::vector<SeamTrial>&& trials);
  void part_strips(double longest, const Progress& progress);
  SeamEdges halve_strips(double longest, const Progress& progress);
  SeamEdges halve_unsolved(double longest, const Progress& progress);
  void take_back(const Progress& progress);

  const SeamSuggestionOptions* options_;
  CutPiece piece_;
  Stage stage_;
  bool changed_;  ///< the seams differ from those of the coarser piece
  std::vector<Futile> futile_;
  KnownMaps tried_;           ///< maps of trials
  std::int64_t n_tried_ = 0;  ///< their vertices
  std::int64_t first_ = 0;    ///< solved vertices when these options were set
  bool finished_ = false;
  bool exhausted_ = false;  ///< no further cut gains
  int partings_ = 0;        ///< steps so far that had defects to part
};

}  // namespace spectral_conformal
