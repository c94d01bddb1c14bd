#pragma once

#include <vector>

#include "seams/pieces.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A piece with fewer vertices and the same topology, for a faster seam search. Vertices are merged only along edges,
/// so the cluster of fine vertices of each coarse vertex is connected, and every coarse edge has a fine edge between
/// the clusters of its ends.
struct CoarsePiece {
  Piece piece;               ///< vertices and faces are some of the whole mesh's, in the order of the fine piece
  PieceMirror mirror;        ///< of the same image; empty where the fine piece is not its own mirror image
  std::vector<int> vertex;   ///< (coarse V,) the vertex of the fine piece
  std::vector<int> cluster;  ///< (fine V,) the coarse vertex into which it was merged
};

/// Merges vertices until about `n_vertices` are left, or no more can be merged. It works in rounds of vertices without
/// common faces, least displacement of the surface first (quadric error metric; Garland and Heckbert 1997), and merges
/// each vertex into its best neighbor. Polygons lose corners. Vertices on the boundary or on a mirror plane stay on it,
/// those of seams stay; mirrored vertices are merged together. index: the number of the piece. preference: (V,), or
/// empty; merging across changes of this value is discouraged. side: (V,), as in MirrorSymmetry, used if the piece is
/// its own image. Coordinates must be finite. Throws Cancelled.
CoarsePiece coarse_piece(const Piece& fine, int index, const PieceMirror& mirror, const std::vector<signed char>& side,
                         const std::vector<double>& preference, int n_vertices, const Progress& progress);

}  // namespace spectral_conformal
