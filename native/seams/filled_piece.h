#pragma once

#include <optional>

#include "seams/pieces.h"

namespace spectral_conformal {

/// A piece with the small holes of scans closed by polygons: they do not matter to seams but prevent coarsening. It has
/// the vertices and edges of the original piece, and its faces first; the added faces have the number -1 in the whole
/// mesh.
struct FilledPiece {
  Piece piece;
  PieceMirror mirror;  ///< with the image of every face, where the piece is its own mirror image
};

/// Fills the boundary loops that are short for the size of the piece, together with their images if the piece is its
/// own mirror image. index: the number of the piece. Empty if there is no such hole. Coordinates must be finite.
std::optional<FilledPiece> fill_small_holes(const Piece& piece, int index, const PieceMirror& mirror);

}  // namespace spectral_conformal
