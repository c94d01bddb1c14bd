#pragma once

#include "seams/coarse_piece.h"
#include "seams/piece_seams.h"

namespace spectral_conformal {

/// Cuts a fine piece like its coarse copy: each chain of seam edges becomes the cheapest path through the clusters of
/// its vertices, in order. The charts of both pieces then correspond. `from`: the seams of coarse.piece. `to`: of the
/// fine piece, without new seams; if `from` is not symmetric, `to` forgets its symmetry.
void carry_seams(const CoarsePiece& coarse, const PieceSeams& from, PieceSeams& to);

}  // namespace spectral_conformal
