#pragma once

#include <vector>

#include "seams/coarse_piece.h"
#include "seams/piece_seams.h"

namespace spectral_conformal {

/// Cuts a fine piece as its coarse one is cut, and returns the edges of each cut: `cuts` are those that led to the
/// seams of `from`, in their order, some of whose edges may have been sewn up since. Each chain of seam edges becomes
/// the cheapest path through the clusters of its vertices, in their order, so that the charts of the fine piece are
/// those of the coarse one. `from` belongs to coarse.piece, and `to` to the piece that it was made from, without new
/// seams.
std::vector<SeamEdges> carry_seams(const CoarsePiece& coarse, const PieceSeams& from,
                                   const std::vector<SeamEdges>& cuts, PieceSeams& to);

}  // namespace spectral_conformal
