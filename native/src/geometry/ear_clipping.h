#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Cuts a counterclockwise polygon of n corners into n - 2 triangles by clipping ears, as corner numbers. The outline
/// may touch itself, run along itself and have coincident corners (a weakly simple polygon): its triangles then cover
/// it once; those between coincident or collinear corners have no area. For a self-crossing outline the triangles are
/// arbitrary (covers_once). Corners nearer than `tolerance` to an edge lie on it. A blocked ear waits for the corner
/// that blocks it, found by a BoxTree.
std::vector<std::array<int, 3>> clip_ears(const std::vector<Complex>& outline, double tolerance);

/// Whether triangles of these points are counterclockwise and do not overlap, up to heights of `tolerance`.
bool covers_once(const std::vector<Complex>& points, const std::vector<std::array<int, 3>>& triangles,
                 double tolerance);

}  // namespace spectral_conformal
