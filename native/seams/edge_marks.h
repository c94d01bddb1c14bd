#pragma once

#include <array>
#include <vector>

#include "mesh/mirror_symmetry.h"
#include "seams/pieces.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// SeamSuggestionOptions::avoided_edges and preferred_edges with their mirror images, because a cut and its image are
/// made together.
class EdgeMarks {
 public:
  /// mesh_vertices: (V,) per canonical vertex, its index in the caller's arrays.
  EdgeMarks(const SeamSuggestionOptions& options, const MirrorSymmetry& symmetry,
            const std::vector<int>& mesh_vertices);

  /// Multiplies the cost factors of a piece's marked edges. On a coarse copy, an edge is marked if both of its ends
  /// belong to marked edges, with the weaker mark. factors: per edge of the graph. Precondition: the graph's costs are
  /// not scaled yet.
  void scale(const SeamGraph& graph, const Piece& piece, bool is_coarse, std::vector<double>& factors) const;
  bool has_preferred() const { return !preferred_.edges.empty(); }
  /// The largest preference of the edges at a canonical vertex. Precondition: has_preferred().
  double preference_at(int vertex) const { return preferred_.largest[vertex]; }

 private:
  struct Mark {
    std::array<int, 2> edge;  ///< canonical vertices, the smaller first
    double strength;
  };
  struct Marks {
    std::vector<Mark> edges;      ///< sorted, each edge once
    std::vector<double> largest;  ///< per canonical vertex, the largest strength of its edges; empty without edges

    double strength(int a, int b, bool is_coarse) const;
  };

  Marks avoided_;  ///< of strength 1
  Marks preferred_;
};

}  // namespace spectral_conformal
