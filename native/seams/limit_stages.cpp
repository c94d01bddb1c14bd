#include "seams/limit_stages.h"

#include <algorithm>
#include <cmath>

namespace spectral_conformal {
namespace {

/// Beyond this, looser limits change nothing.
constexpr double loosest_share = 16;
/// Stricter limits add no more cuts. What is allowed there is about what the functional takes for none.
constexpr double strictest_share = 1.0 / 64;

bool are_as_strict(const SeamSuggestionOptions& some, const SeamSuggestionOptions& others) {
  return some.energy_limit <= others.energy_limit && some.scale_limit <= others.scale_limit &&
         some.qc_limit <= others.qc_limit;
}

}  // namespace

/// Lengths are measured from the seams that topology needs, a price of QC is no limit, and the shortest seams use up
/// the very limits asked for.
LimitStages::LimitStages(const SeamSuggestionOptions& asked, bool has_copies)
    : asked_(asked),
      is_loose_(!are_as_strict(asked, SeamSuggestionOptions{})),
      is_staged_(!std::isfinite(asked.max_length) && !(asked.qc_gain > 0) && !asked.shortest &&
                 !(is_loose_ && has_copies)),
      share_(is_loose_ ? loosest_share : 1) {}

SeamSuggestionOptions LimitStages::limits() const {
  if (!is_staged_) return asked_;
  const SeamSuggestionOptions usual;
  SeamSuggestionOptions result = asked_;
  const auto is_asked = [&](double limit, double usual_limit) { return is_loose_ || limit < usual_limit; };
  if (is_asked(asked_.energy_limit, usual.energy_limit)) result.energy_limit = 4 + share_ * (usual.energy_limit - 4);
  if (is_asked(asked_.qc_limit, usual.qc_limit)) result.qc_limit = 1 + share_ * (usual.qc_limit - 1);
  // The energy grows with the square of the logarithm.
  if (is_asked(asked_.scale_limit, usual.scale_limit)) {
    result.scale_limit = std::pow(usual.scale_limit, std::sqrt(share_));
  }
  return result;
}

SeamSuggestionOptions LimitStages::no_looser_than_usual(SeamSuggestionOptions asked) {
  const SeamSuggestionOptions usual;
  asked.energy_limit = std::min(asked.energy_limit, usual.energy_limit);
  asked.qc_limit = std::min(asked.qc_limit, usual.qc_limit);
  asked.scale_limit = std::min(asked.scale_limit, usual.scale_limit);
  return asked;
}

bool LimitStages::advance() {
  if (!is_staged_ || share_ <= strictest_share || are_as_strict(limits(), asked_)) return false;
  share_ /= 2;
  return true;
}

}  // namespace spectral_conformal
