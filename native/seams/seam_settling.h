#pragma once

#include "seams/cut_piece.h"

namespace spectral_conformal {

/// Removes and straightens seams of a piece while that lowers the functional and makes no flips or overlaps. A move
/// removes a chain of seams; or a half, a quarter or an eighth of it from one end, if the rest still meets other seams;
/// or replaces it by the cheapest path between its ends. Moves that may save most come first; a failed move is not
/// tried again. Ends after solving for `max_vertices` vertices. Throws Cancelled.
void settle_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress);

}  // namespace spectral_conformal
