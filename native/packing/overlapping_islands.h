#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The first island of the group of each of `n` islands. Islands that overlap are in one group, and so are those that
/// overlap others of the group. As for faces (overlapping_triangles), contacts that single precision does not tell from
/// overlaps do not count. Arguments as in island_outlines.
std::vector<int> overlapping_islands(const ComplexVector& points, const std::vector<int>& face_offsets,
                                     const std::vector<int>& corners, const std::vector<int>& island_of_face, int n);

}  // namespace spectral_conformal
