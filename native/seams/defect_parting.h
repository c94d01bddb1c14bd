#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "seams/cut_candidates.h"
#include "seams/cut_piece.h"

namespace spectral_conformal {

/// Parts the charts of a piece that cover themselves or have flipped faces, each in its own way.
class DefectParting {
 public:
  struct Limits {
    double longest;           ///< length of all cuts together
    int max_chosen_vertices;  ///< of larger charts the defects are cut out without trials
    bool halves;              ///< where these are too many, such charts are halved
  };

  /// The options and the piece, which stays as it is, must outlive this object. Throws Cancelled.
  DefectParting(CutPiece& piece, const SeamSuggestionOptions& options, const Limits& limits, const Progress& progress);

  /// Whether no chart has defects.
  bool is_sound() const { return parted_.empty(); }
  /// The cuts that part the charts with defects, as far as they are not too long together; empty where there are none.
  /// Throws Cancelled.
  SeamTrial part(const Progress& progress);

 private:
  /// What parts the defects of one chart.
  struct Parting {
    SeamEdges cut;          ///< empty where it would be too long
    TrialMaps charts;       ///< the maps of it that are not there yet
    TrialMaps tried;        ///< those of its trials, as far as they are few
    std::int64_t room = 0;  ///< vertices of maps that these still take
  };
  /// Faces of the piece that cover others or are flipped, and their areas.
  using Defects = std::map<int, double>;
  /// A cut that removes some of a chart's defects, and these.
  struct PartCut {
    SeamEdges cut;
    Defects removed;
  };

  Parting part_chart(int chart, std::int64_t remembered, const Progress& progress) const;
  SeamEdges part_large_chart(int chart) const;
  Defects defects_of(const TrialMap& mapped, const std::vector<int>& faces) const;
  Defects defects_left(const SeamTrial& trial, const Defects& before) const;
  SeamTrial best_parting(const Defects& defects, std::vector<SeamEdges>&& cuts, bool at_any_price,
                         std::vector<PartCut>& some, Parting& parting, const Progress& progress) const;
  SeamTrial part_together(const Defects& defects, const std::vector<PartCut>& some, const Progress& progress) const;
  SeamEdges cut_together(const std::vector<PartCut>& cuts) const;
  double price(const SeamEdges& cut) const;
  bool is_too_distorted(const SeamTrial& trial) const;

  CutPiece& piece_;
  const SeamSuggestionOptions& options_;
  Limits limits_;
  CutCandidates candidates_;
  std::vector<std::vector<int>> defects_;  ///< per chart, as defective_faces returns them
  std::vector<int> parted_;                ///< charts with defects, without the second of mirrored ones
};

}  // namespace spectral_conformal
