#pragma once

#include <array>
#include <vector>

#include "graph/adjacency.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// An order of the nodes of a graph with each part before its surrounding separators (nested dissection, George 1973).
struct NestedDissection {
  std::vector<int> order;                  ///< (n,) nodes; within a leaf in no particular order
  std::vector<std::array<int, 2>> leaves;  ///< [begin, end) in `order` of the undissected parts
};

/// Dissects a graph with nodes in 3D and neighbors close together. A plane cuts each part in half; among several
/// directions, it takes the one that cuts the fewest nodes of a sample. A smallest separator is then chosen among the
/// nodes near the plane. Parts are dissected in several threads; the result does not depend on their number. positions:
/// (n, 3). Parts that no plane cuts, such as coincident nodes, remain leaves.
NestedDissection nested_dissection(const Adjacency& graph, const Eigen::Ref<const Positions>& positions);

}  // namespace spectral_conformal
