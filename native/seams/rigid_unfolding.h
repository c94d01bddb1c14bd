#pragma once

#include <vector>

#include "seams/pieces.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// Seams that let a piece unfold into the plane without distortion, like a paper model: the uncut edges of the graph
/// that are not hinges, by index. Coplanar faces form a facet. Facets, and then nets of facets, are joined pair by
/// pair, most expensive common seam first (SeamGraph::Edge::cost), if
///  - a rigid motion aligns edges that they share, which become hinges,
///  - their images do not overlap,
///  - the hinge spans enough of the narrower net's width along it, so that nothing dangles from a corner: a cap comes
///    off its pipe, and a box stays one cross.
/// The seams are the borders of the nets and, within a net, the cuts that its topology requires, such as one along a
/// pipe. A non-developable surface falls into many nets, whose seams cost more than its distortion would. Empty for a
/// piece with more than max_facets facets (rigid_unfolding.cpp). Coordinates must be finite.
std::vector<int> rigid_unfolding_seams(const Piece& piece, const SeamGraph& graph);

}  // namespace spectral_conformal
