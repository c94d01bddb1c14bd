#pragma once

#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// What a style means: factors in the functional (seam_functional.h). Hard surfaces have 1 for each.
struct StyleWeights {
  double island;  ///< factor of the price of an island
  double front;   ///< factor of SeamSuggestionOptions::front
};

StyleWeights weights_of(SeamStyle style);

}  // namespace spectral_conformal
