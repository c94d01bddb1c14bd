#pragma once

#include <vector>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The rows of a symmetric matrix by falling distance, in its graph, from one of its ends: the node that is farthest
/// from the first row; one connected part after the other. Minimum degree breaks ties by the numbers of rows: with
/// these it takes away layer by layer, where those that a mesh came with may leave it scattered fronts.
std::vector<int> numbering_by_distance(const HermitianMatrix& matrix);

}  // namespace spectral_conformal
