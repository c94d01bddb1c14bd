#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "seams/cut_candidates.h"
#include "seams/cut_piece.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The search for the cuts of one piece, which lowers the functional (seam_functional.h). It solves the proposals of
/// CutCandidates, and makes those cuts that lower it most. When none does, it parts charts that overlap themselves or
/// have flipped faces (defect_parting.h), until none are left. In the end it takes seams back (seam_settling.h).
class Cutter {
 public:
  /// Where in the search a piece is: it may stand for a finer one, and its seams may come from a coarser one.
  struct Stage {
    int n_vertices = 0;     ///< of the finest piece, which the number of trials is chosen by
    bool refined = false;   ///< the seams were found on a coarser piece, or in another way
    bool is_large = false;  ///< no more than has to be is solved for at the finer levels
    double mesh_area = 0;   ///< of the whole mesh, which SeamSuggestionOptions::qc_gain is for; 0: of the piece alone
  };

  /// `seams` are open already (PieceSeams::open). `options` must outlive this object.
  Cutter(PieceSeams seams, const SeamSuggestionOptions& options);
  Cutter(PieceSeams seams, const SeamSuggestionOptions& options, const Stage& stage);

  /// Solves the piece with the seams that it has. Throws Cancelled.
  void solve(const Progress& progress) { piece_.solve({}, progress); }
  /// The next cuts, not longer than `longest` together; they are added to seams(). Empty, and finished() from then on,
  /// where there are none; what was taken back is then no longer in seams(). Throws Cancelled.
  SeamEdges step(double longest, const Progress& progress);
  /// For seams that were found in another way, instead of step(): parts charts with defects, then takes seams back.
  /// Throws Cancelled.
  void settle(const Progress& progress);
  /// Whether no chart has defects.
  bool is_sound() const;

  bool finished() const { return finished_; }
  const PieceSeams& seams() const { return piece_.seams(); }
  const MapQuality& quality() const { return piece_.quality(); }
  /// Of the functional.
  double value() const { return piece_.value(); }
  /// The maps of the charts that seams() make.
  const TrialMaps& charts() const { return piece_.charts(); }
  /// Vertices of all charts that were solved so far, which the time of the search goes with.
  std::int64_t solved_vertices() const { return piece_.solved_vertices(); }

 private:
  /// A cut that is to be tried.
  struct Proposal {
    SeamEdges cut;
    bool may_part = false;  ///< whether it may make islands
    int chart = -1;         ///< that it is in, -1 for several
  };
  /// A cut that gained nothing in a chart, which is kept so that no other can take its place in memory.
  using Futile = std::pair<std::shared_ptr<const TrialMap>, SeamEdges>;

  bool hurries() const { return stage_.refined && stage_.is_large; }  ///< at the finer levels of a large piece
  bool grows() const;
  CutCandidates candidates() const { return {seams(), charts(), quality()}; }
  SeamEdges accept(SeamTrial&& trial);
  bool is_tried(const Proposal& proposal) const;
  std::vector<SeamTrial> gaining(std::vector<Proposal> proposals, double longest, const Progress& progress);
  SeamEdges accept_best(std::vector<SeamTrial>&& trials, double longest, const Progress& progress);

  SeamEdges cut_to_all(double longest, const Progress& progress);
  SeamEdges best_cut(double longest, const Progress& progress);
  SeamEdges split_in_half(double longest, const Progress& progress);
  SeamEdges part_defects(double longest, const Progress& progress);
  SeamEdges halve_unsolved(double longest, const Progress& progress);

  const SeamSuggestionOptions& options_;
  CutPiece piece_;
  Stage stage_;
  bool changed_;  ///< seams are not those of a coarser piece
  std::vector<Futile> futile_;
  bool finished_ = false;
  bool exhausted_ = false;  ///< no cut gains any more
  int losses_together_ = 0;
  int partings_ = 0;  ///< steps that part defects
};

}  // namespace spectral_conformal
