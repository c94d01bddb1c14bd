#pragma once

#include <array>
#include <vector>

#include "mesh/mirror_symmetry.h"
#include "seams/pieces.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// SeamSuggestionOptions::avoided_edges with their mirror images, because a cut and its image are made together.
class AvoidedEdges {
 public:
  /// mesh_vertices: per vertex of the mesh in canonical order, its index in the arrays of the caller.
  AvoidedEdges(const SeamSuggestionOptions& options, const MirrorSymmetry& symmetry,
               const std::vector<int>& mesh_vertices);

  /// Raises the cost factors of the avoided edges of a piece's graph. On a coarse copy, those are the edges whose ends
  /// both belong to avoided edges.
  void raise(const SeamGraph& graph, const Piece& piece, bool is_coarse, std::vector<double>& factors) const;

 private:
  std::vector<std::array<int, 2>> edges_;  ///< canonical vertices, the smaller first, sorted
  std::vector<char> is_end_;               ///< per canonical vertex; empty without avoided edges
};

}  // namespace spectral_conformal
