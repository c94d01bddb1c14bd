#pragma once

#include <array>
#include <vector>

#include "mesh/charts.h"
#include "mesh/mirror_symmetry.h"
#include "mesh/owned_mesh.h"

namespace spectral_conformal {

/// One chart as a separate mesh with the chart's own vertices: the seams around it become its boundary.
/// The seams are those inside the chart that do not separate it, and its slits (pieces.cpp).
struct Piece : OwnedMesh {
  Positions given;            ///< (V, 3) in the whole mesh, if `positions` are rounded; otherwise empty
  std::vector<int> vertices;  ///< (V,) in the whole mesh
  std::vector<int> faces;     ///< (F,) in the whole mesh

  Positions corners(int face) const;  ///< (corners of the face, 3)
  double area() const;                ///< the sum of the lengths of its faces' vector areas
};

/// Whether its vertices are finite and not all in one place.
bool has_extent(const Piece& piece);

/// The pieces of a mesh, one per chart, in the order of the charts.
std::vector<Piece> split_into_pieces(const PolygonMesh& mesh, const ChartDecomposition& decomposition);

/// The action of a mirror symmetry of the mesh on a piece.
struct PieceMirror {
  int image = -1;  ///< index of the mirrored piece, which may be the piece itself; -1: none, and the rest is empty
  std::vector<int> vertex;  ///< (V,) vertex of the image
  std::vector<int> face;    ///< (F,) face of the image
};

/// One per piece. The image is a single piece with the same cuts, or there is none.
std::vector<PieceMirror> mirror_pieces(const PolygonMesh& mesh, const ChartDecomposition& decomposition,
                                       const std::vector<Piece>& pieces, const MirrorSymmetry& symmetry);

/// The pieces of a mesh, and how the plane that mirrors most of the mesh acts on them.
struct MirroredPieces {
  static MirroredPieces of(const PolygonMesh& mesh);

  std::vector<Piece> pieces;
  MirrorSymmetry symmetry;
  std::vector<PieceMirror> mirrors;  ///< per piece
};

}  // namespace spectral_conformal
