#pragma once

#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal {

/// Copies to each texel without coverage the nearest one with some, by the distance of their centers. Without any,
/// nothing changes.
void fill_margin(const TargetImage& image);

}  // namespace spectral_conformal
