#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Corners that are joined to points.
struct WeldedCorners {
  std::vector<int> point;         ///< (C,) of each corner
  std::vector<int> first_corner;  ///< of each point
};

/// Joins the corners of an island that have the same vertex and UV, so that the faces meet as in the map.
/// vertices: (C,) from 0 to n_vertices - 1; islands: (C,); uv: (C,).
WeldedCorners welded_corners(const int* vertices, const int* islands, const Complex* uv, int n_corners, int n_vertices);

}  // namespace spectral_conformal
