#pragma once

#include <vector>

#include "seams/pieces.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// A piece with fewer vertices and the same topology, for a faster seam search. Vertices are merged only along edges,
/// so each coarse vertex stands for a connected cluster of fine vertices, and a fine edge joins the clusters of the
/// ends of every coarse edge.
struct CoarsePiece {
  Piece piece;               ///< its vertices and faces are a subset of the fine piece's, in its order
  PieceMirror mirror;        ///< onto itself; empty if the fine piece is not its own mirror image
  std::vector<int> vertex;   ///< (coarse V,) the index in the fine piece
  std::vector<int> cluster;  ///< (fine V,) the coarse vertex that stands for it
};

/// Merges vertices until about `n_vertices` are left, or none can be merged. Each round merges vertices without common
/// faces into their best neighbors, least displacement of the surface first (quadric error metric; Garland and Heckbert
/// 1997). Polygons lose corners. Vertices on the boundary or on the mirror plane stay on it, those on one side of the
/// plane on that side, and vertices of seams stay. Mirrored vertices are merged together. index: of the fine piece.
/// preference: (V,), or empty; merges across changes of this value cost more. side: (V,), as in MirrorSymmetry, used if
/// the piece is its own mirror image. Coordinates must be finite. Throws Cancelled.
CoarsePiece coarse_piece(const Piece& fine, int index, const PieceMirror& mirror, const std::vector<signed char>& side,
                         const std::vector<double>& preference, int n_vertices, const Progress& progress);

}  // namespace spectral_conformal
