#pragma once

#include <vector>

#include "seams/pieces.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A piece with fewer vertices and the same topology, in which seams are looked for faster. Vertices are only merged
/// into others along edges, so what lies around a vertex of the coarse piece, its cluster, is connected, and every edge
/// of the coarse piece is there between the clusters of its ends, too.
struct CoarsePiece {
  Piece piece;               ///< vertices and faces are some of the whole mesh's, in the order of the fine piece
  PieceMirror mirror;        ///< of the same image; empty where the fine piece is not its own mirror image
  std::vector<int> vertex;   ///< (coarse V,) the vertex of the fine piece
  std::vector<int> cluster;  ///< (fine V,) the coarse vertex into which it was merged
};

/// Merges vertices until about `n_vertices` are left, or no other can be merged: in rounds of vertices that have no
/// face in common, those first whose merging moves the surface least (quadric error metric; Garland and Heckbert 1997),
/// each into the neighbor that is best. Polygons lose corners. Vertices on the boundary stay on it, those of seams
/// stay, and those on a mirror plane stay on it; mirrored vertices are merged together. `index` is the number of the
/// piece, `preference` (V,) a number per vertex across whose changes vertices are rather not merged, or empty. `side`
/// (V,) as in MirrorSymmetry, used where the piece is its own image. Coordinates must be finite. Throws Cancelled.
CoarsePiece coarse_piece(const Piece& fine, int index, const PieceMirror& mirror, const std::vector<signed char>& side,
                         const std::vector<double>& preference, int n_vertices, const Progress& progress);

}  // namespace spectral_conformal
