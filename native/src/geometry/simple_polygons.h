#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Whether closed polygons are simple and disjoint: no two of their edges meet, except neighbors at their common
/// vertex, and no edge has collapsed. By exact predicates, as a line sweeps over the edges (Shamos and Hoey 1976,
/// "Geometric intersection problems", FOCS). polygons: vertices in order, at least three each; z: (V,), finite. O(n log
/// n) for n edges.
bool are_simple_polygons(const std::vector<BoundaryLoop>& polygons, const ComplexVector& z);

}  // namespace spectral_conformal
