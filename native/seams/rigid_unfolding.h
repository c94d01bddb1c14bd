#pragma once

#include <vector>

#include "seams/pieces.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// Seams that let a piece unfold into the plane without distortion, like a paper model: the uncut edges of the graph
/// that are not hinges. Coplanar faces form a facet. Facets, and then nets of facets, are joined pair by pair, most
/// expensive common seam first (SeamGraph::Edge::cost), if
///  - a rigid motion brings edges that they share together, which become hinges,
///  - their images do not overlap,
///  - the hinge is at least a part of the width that each has along it, so that nothing dangles from a corner: a cap
///    comes off its pipe, and a box stays one cross.
/// The seams are the borders of the nets, and within a net the lines that its topology requires, such as one along a
/// pipe. A non-developable surface falls into many nets, whose seams cost more than its distortion. Empty for pieces of
/// more than `max_facets` facets. Coordinates must be finite.
std::vector<int> rigid_unfolding_seams(const Piece& piece, const SeamGraph& graph);

}  // namespace spectral_conformal
