#pragma once

#include <optional>

#include "seams/pieces.h"

namespace spectral_conformal {

/// A piece with small holes, as in scans, closed by polygons: such holes do not matter for seams but prevent
/// coarsening. It has the vertices and edges of the original piece, and its faces, followed by the added ones.
/// Piece::faces is -1 for these.
struct FilledPiece {
  Piece piece;
  PieceMirror mirror;  ///< includes the added faces if the piece is its own mirror image
};

/// Fills boundary loops that are short relative to the piece; if the piece is its own mirror image, only together with
/// their images. index: of the piece. Empty if there is no such loop. Coordinates must be finite.
std::optional<FilledPiece> fill_small_holes(const Piece& piece, int index, const PieceMirror& mirror);

}  // namespace spectral_conformal
