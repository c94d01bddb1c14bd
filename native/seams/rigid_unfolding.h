#pragma once

#include <vector>

#include "seams/pieces.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// Seams that let a piece unfold into the plane without any distortion, as paper models are cut: the edges of the
/// graph, not cut yet, that are no hinge. Faces in one plane are a facet. Facets, and then nets of facets, are joined
/// one pair after the other, those first whose common edges cost most as seams (`price` per edge of the graph), if
///  - a rigid motion brings edges that they share together, which become hinges,
///  - their images do not overlap,
///  - the hinge is at least a part of the width that each has along it, so that nothing dangles from a corner: a cap
///    comes off its pipe, and a box stays one cross.
/// What is left are the borders of the nets, and within a net the lines that its topology needs: one along a pipe.
/// A surface that is not developable falls into many nets, whose seams cost more than its distortion.
/// Empty for pieces of more than `max_facets` facets. `price` must be positive where it is not cut; coordinates finite.
std::vector<int> rigid_unfolding_seams(const Piece& piece, const SeamGraph& graph, const std::vector<double>& price);

}  // namespace spectral_conformal
