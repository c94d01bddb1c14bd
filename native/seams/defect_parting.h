#pragma once

#include <map>
#include <vector>

#include "seams/cut_candidates.h"
#include "seams/cut_piece.h"

namespace spectral_conformal {

/// Parts the charts of a piece that overlap themselves or have flipped faces, each on its own.
class DefectParting {
 public:
  struct Limits {
    double longest;           ///< length of all cuts together
    int max_chosen_vertices;  ///< in larger charts, defects are cut out without trials
    bool halves;              ///< whether larger charts with too many defects are halved
  };

  /// Finds the defects. `piece` and `options` must outlive this object, and the seams of the piece must not change.
  /// Throws Cancelled.
  static DefectParting of(CutPiece& piece, const SeamSuggestionOptions& options, const Limits& limits,
                          const Progress& progress);

  /// Whether no chart has defects.
  bool is_sound() const { return parted_.empty(); }
  /// The trial of the cuts that part the charts with defects, within the limit of length; empty if there are none.
  /// Throws Cancelled.
  SeamTrial part(const Progress& progress);

 private:
  DefectParting(CutPiece& piece, const SeamSuggestionOptions& options, const Limits& limits);

  /// The cut that parts the defects of one chart, and its maps.
  struct Parting {
    SeamEdges cut;     ///< empty if it would be too long
    TrialMaps charts;  ///< with it
  };
  /// Faces of the piece that overlap others or are flipped, with their areas.
  using Defects = std::map<int, double>;
  /// A cut, and the defects of a chart that it removes.
  struct PartCut {
    SeamEdges cut;
    Defects removed;
  };

  Parting part_chart(int chart, const Progress& progress) const;
  SeamEdges part_large_chart(int chart) const;
  Defects defects_of(const TrialMap& mapped, const std::vector<int>& faces) const;
  Defects defects_left(const SeamTrial& trial, const Defects& before) const;
  SeamTrial best_parting(const Defects& defects, std::vector<SeamEdges>&& cuts, bool at_any_price,
                         std::vector<PartCut>& some, const Progress& progress) const;
  SeamTrial part_together(const Defects& defects, const std::vector<PartCut>& some, const Progress& progress) const;
  SeamEdges cut_together(const std::vector<PartCut>& cuts) const;
  double price(const SeamEdges& cut) const;
  bool is_too_distorted(const SeamTrial& trial) const;

  CutPiece& piece_;
  const SeamSuggestionOptions& options_;
  Limits limits_;
  CutCandidates candidates_;
  std::vector<std::vector<int>> defects_;  ///< per chart, see defective_faces
  std::vector<int> parted_;                ///< charts with defects; of mirrored ones, only the first
};

}  // namespace spectral_conformal
