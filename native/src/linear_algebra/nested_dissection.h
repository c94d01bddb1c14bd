#pragma once

#include <array>
#include <vector>

#include "graph/adjacency.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The nodes of a graph, those of each part before the separators round it (nested dissection, George 1973).
struct NestedDissection {
  std::vector<int> order;                  ///< (n,) nodes; those of a leaf in no particular order
  std::vector<std::array<int, 2>> leaves;  ///< [begin, end) in `order`, of parts that were not dissected
};

/// Dissects a graph whose nodes lie in space, neighbors close to each other. Each part is cut in half by a plane, of
/// several directions the one that cuts fewest nodes by a sample of them, and of the nodes near the plane a smallest
/// separator is taken. Parts are dissected in several threads; the result does not depend on their number.
/// positions: (n, 3). Parts that no plane cuts, such as nodes all at one place, remain leaves.
NestedDissection nested_dissection(const Adjacency& graph, const Eigen::Ref<const Positions>& positions);

}  // namespace spectral_conformal
