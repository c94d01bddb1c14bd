#pragma once

#include <vector>

namespace spectral_conformal {

/// The sides of triangles that no other triangle has between the same two corners: those at the borders of islands, of
/// triangles (n_triangles, 3) of corners. Side s of triangle t, from its corner s to the next one, has the number
/// 3 t + s. They ascend.
std::vector<int> border_sides(const int* triangles, int n_triangles);

}  // namespace spectral_conformal
