#pragma once

#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The stages of a search: limits that do not depend on those asked for, each allowing half of the distortion of the
/// one before. The first stage allows as much as the default limits or, if any limit asked for is looser, 16 times as
/// much; it is searched and settled. The others only add cuts, until the limits asked for are met. So among limits with
/// the same first stage, the seams for one are part of those for any stricter one. A piece that is searched on coarse
/// copies has no stages for looser limits: cuts added to the piece itself make up badly for those of its copies.
///
/// Where the first stage is looser than usual, the seams for the limits no looser than usual may still be shorter, and
/// meet those asked for too: the shorter of the two are, for every limit, at most as long as for any stricter one.
class LimitStages {
 public:
  /// `asked` must outlive this object.
  LimitStages(const SeamSuggestionOptions& asked, bool has_copies);

  /// The limits of the present stage, with the other options asked for. Of limits that are all at least as strict as
  /// the default ones, those left at their defaults stay.
  SeamSuggestionOptions limits() const;
  /// The same for coarse copies, where less energy is allowed.
  SeamSuggestionOptions limits_of_copies() const;
  /// Goes on to the next stage. Returns false if this one is at least as strict as asked, or the last.
  bool advance();
  /// Whether the first stage is looser than usual.
  bool begins_looser() const { return is_staged_ && is_loose_; }
  /// Limits asked for, the looser ones among them replaced by the default ones.
  static SeamSuggestionOptions no_looser_than_usual(SeamSuggestionOptions asked);

 private:
  const SeamSuggestionOptions& asked_;
  bool is_loose_;  ///< whether any limit is looser than by default
  bool is_staged_;
  double share_;  ///< of what the default limits allow
};

}  // namespace spectral_conformal
