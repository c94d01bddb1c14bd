#pragma once

#include <array>
#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Cuts a polygon of n corners, counter-clockwise, into n - 2 triangles by clipping ears, as corner numbers. The
/// outline may touch itself, run along itself and have corners that coincide (a weakly simple polygon): its triangles
/// then cover it once, those between coincident or collinear corners without area. Of an outline that crosses itself
/// the triangles are some (covers_once). Corners nearer than `tolerance` to an edge lie on it. An ear that is blocked
/// waits for the corner that blocks it, found by a BoxTree.
std::vector<std::array<int, 3>> clip_ears(const std::vector<Complex>& outline, double tolerance);

/// Whether triangles of these points are counter-clockwise and cover no place twice, up to heights of `tolerance`.
bool covers_once(const std::vector<Complex>& points, const std::vector<std::array<int, 3>>& triangles,
                 double tolerance);

}  // namespace spectral_conformal
