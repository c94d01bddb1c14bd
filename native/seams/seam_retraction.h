#pragma once

#include <cstdint>

#include "seams/cut_piece.h"

namespace spectral_conformal {

/// Takes seams of a piece back while no limit is exceeded further, and no flips or overlaps appear. A step removes part
/// of a chain from one of its ends, be it a tip or a crossing; the rest must still meet other seams. First comes the
/// step that saves most seams, by their price, per distortion added. Chains are first tried whole; a part that failed
/// is halved, down to single edges. Rates are measured again only where an old one, which may be stale, is above the
/// best new one: those of other ends hardly change, and mostly fall ("lazy greedy"; Minoux 1978). Ends after solving
/// for `max_vertices` vertices. Returns whether anything was removed. Throws Cancelled.
bool retract_seams(CutPiece& piece, std::int64_t max_vertices, const Progress& progress);

}  // namespace spectral_conformal
