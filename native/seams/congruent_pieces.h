#pragma once

#include <vector>

#include "seams/pieces.h"
#include "seams/seam_preferences.h"

namespace spectral_conformal {

/// Whose seams a piece gets. Repeated parts, such as bolts, have the same seams wherever they lie, for one search.
struct PieceCopy {
  int source = -1;          ///< index of the piece that is searched; its own if that is this one
  std::vector<int> vertex;  ///< (V,) per vertex of the source, that of this piece; empty for the source itself
};

/// One per piece. A piece is a copy of another one if the mesh's mirror symmetry maps it onto that, or if a rotation
/// and a translation do, up to 1e-4 of its size and, with `any_size`, a scale, and `preferences` treat both alike.
/// Pieces that are their own mirror image are sources first, so that seams stay symmetric. O(n log n) time for n
/// corners, if few of the pieces with the same numbers of vertices, faces and corners differ in shape.
std::vector<PieceCopy> copies_of_pieces(const MirroredPieces& parts, const SeamPreferences& preferences, bool any_size);

}  // namespace spectral_conformal
