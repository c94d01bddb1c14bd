#pragma once

#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// What a style means: factors in the functional (seam_functional.h).
struct StyleWeights {
  double island;      ///< factor of the price of an island
  double front;       ///< factor of SeamSuggestionOptions::front
  double turn;        ///< factor of the price of turns
  double least_turn;  ///< what a right angle costs at least, times `turn`, in roots of the mesh's area
  /// An unfolding, which follows sharp edges without distortion, wins unless the other seams are better by this factor:
  /// its hinges are wide, which the functional does not see.
  double unfolding;
};

StyleWeights weights_of(SeamStyle style);

}  // namespace spectral_conformal
