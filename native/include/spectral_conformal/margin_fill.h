#pragma once

#include <vector>

#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal {

/// Copies to each texel that is not covered, (height, width), the nearest covered one, by the distance of their
/// centers. Without any, nothing changes.
void fill_margin(const TargetImage& image, const std::vector<unsigned char>& covered);

}  // namespace spectral_conformal
