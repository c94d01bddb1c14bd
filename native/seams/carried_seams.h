#pragma once

#include "seams/coarse_piece.h"
#include "seams/piece_seams.h"

namespace spectral_conformal {

/// Cuts a fine piece like its coarse one: each chain of seam edges becomes the cheapest path through the clusters of
/// its vertices, in order, so that the charts of the fine piece correspond to those of the coarse one. `from` belongs
/// to coarse.piece, `to` to the piece from which it was made, without new seams.
void carry_seams(const CoarsePiece& coarse, const PieceSeams& from, PieceSeams& to);

}  // namespace spectral_conformal
