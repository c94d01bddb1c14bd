#pragma once

#include <optional>

#include "seams/pieces.h"

namespace spectral_conformal {

/// A piece without the small holes of scans, which no seam has to heed but which keep a coarse copy from getting
/// coarse: each is closed by a polygon. It has the vertices and edges of the piece it is made from, and its faces
/// first; the number of the others in the whole mesh is -1.
struct FilledPiece {
  Piece piece;
  PieceMirror mirror;  ///< with the image of every face, where the piece is its own mirror image
};

/// Fills the boundary loops of a piece that are short for its size, together with their images where it is its own
/// mirror image. `index` is its number. None where there is no such hole. Coordinates must be finite.
std::optional<FilledPiece> fill_small_holes(const Piece& piece, int index, const PieceMirror& mirror);

}  // namespace spectral_conformal
