#include "seams/limit_stages.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace spectral_conformal {
namespace {

/// Beyond this, looser limits change nothing.
constexpr double loosest_share = 16;
/// Stricter limits add no more cuts. What is allowed there is about what the functional takes for none.
constexpr double strictest_share = 1.0 / 64;
/// Share of the energy allowed on coarse copies: with the same seams, finer copies have more of it, and cutting those
/// further takes longer. Where the shortest seams are wanted, it is not reduced: what is not taken back on a coarse
/// copy takes longer to take back on a finer one.
constexpr double share_of_copies = 0.85;

struct Limit {
  double SeamSuggestionOptions::*value;
  double infimum;
  bool is_factor;  ///< the energy grows with the square of its logarithm

  /// The limit that allows this share of what another one does.
  double allowing(double share, double other) const {
    return is_factor ? std::pow(other, std::sqrt(share)) : infimum + share * (other - infimum);
  }
};

constexpr Limit of_energy{&SeamSuggestionOptions::energy_limit, 4, false};
constexpr std::array<Limit, 3> all_limits{
    {of_energy, {&SeamSuggestionOptions::qc_limit, 1, false}, {&SeamSuggestionOptions::scale_limit, 1, true}}};

bool are_as_strict(const SeamSuggestionOptions& some, const SeamSuggestionOptions& others) {
  return std::all_of(all_limits.begin(), all_limits.end(),
                     [&](const Limit& limit) { return some.*limit.value <= others.*limit.value; });
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
  for (const Limit& limit : all_limits) {
    const double by_default = usual.*limit.value;
    if (is_loose_ || asked_.*limit.value < by_default) result.*limit.value = limit.allowing(share_, by_default);
  }
  return result;
}

SeamSuggestionOptions LimitStages::limits_of_copies() const {
  SeamSuggestionOptions result = limits();
  if (!result.shortest) result.energy_limit = of_energy.allowing(share_of_copies, result.energy_limit);
  return result;
}

SeamSuggestionOptions LimitStages::no_looser_than_usual(SeamSuggestionOptions asked) {
  const SeamSuggestionOptions usual;
  for (const Limit& limit : all_limits) asked.*limit.value = std::min(asked.*limit.value, usual.*limit.value);
  return asked;
}

bool LimitStages::advance() {
  if (!is_staged_ || share_ <= strictest_share || are_as_strict(limits(), asked_)) return false;
  share_ /= 2;
  return true;
}

}  // namespace spectral_conformal
