#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// No point moves farther in a coordinate.
constexpr double max_snap = 0.5;

/// Moves the points, in pixels, so that straight borders of islands along the axes lie between whole texels, at integer
/// coordinates. In each coordinate, an island's points move by a function that is linear between its straight borders
/// and a translation beyond the outermost. So islands do not fold, and straight borders stay straight. Of borders
/// within half a texel of one integer, the longest gets there; borders shorter than a texel do not count.
/// Arguments as in island_outlines.
void snap_to_texels(ComplexVector& points, const std::vector<int>& face_offsets, const std::vector<int>& corners,
                    const std::vector<int>& island_of_face, int n);

}  // namespace spectral_conformal
