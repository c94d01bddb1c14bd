#pragma once

#include "seams/cut_piece.h"

namespace spectral_conformal {

/// Takes seams of a piece back and straightens them, as long as that lowers the functional and makes no flips or
/// overlaps. The moves: a chain of seams is removed, or a half, a quarter or an eighth of it at an end where the rest
/// still meets other seams, or replaced by the cheapest path between its ends. Those that may save most are tried
/// first; a move that failed is not tried again. It ends when `max_vertices` were solved for. Throws Cancelled.
void settle_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress);

}  // namespace spectral_conformal
