#pragma once

#include <cstdint>

#include "seams/cut_piece.h"

namespace spectral_conformal {

/// Straightens and removes seams of a piece while that lowers the functional and makes no flips or overlaps. Chains are
/// replaced by the cheapest paths between their ends, closed ones by edge loops, all at once if that pays. Then a chain
/// is removed, or a half of it from one end, or a quarter or an eighth from a tip, if the rest still meets other seams;
/// those that may save most come first. Then the others are straightened again. What has failed is not tried again.
/// Ends after solving for `max_vertices` vertices. Throws Cancelled.
void settle_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress);

/// Cuts edge loops whole that are cut but for a narrow hinge (PieceSeams::open_rings), while that lowers the functional
/// and makes no flips or overlaps, and settles the seams again after each. Throws Cancelled.
void complete_rings(CutPiece& piece, std::int64_t max_vertices, const Progress& progress);

/// Straightens seams and takes parts of them back (seam_retraction.h) while that makes them shorter, by their price,
/// and exceeds no limit further, whatever it does to the distortion within the limits. Makes no flips or overlaps. Ends
/// after solving for `max_vertices` vertices. Throws Cancelled.
void shorten_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress);

}  // namespace spectral_conformal
