#pragma once

#include <array>
#include <vector>

#include "mesh/mirror_symmetry.h"
#include "seams/pieces.h"
#include "seams/seam_graph.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// Where the user wants seams: SeamSuggestionOptions::front, vertex_preference, avoided_edges and preferred_edges, the
/// edges with their mirror images, because a cut and its image are made together.
class SeamPreferences {
 public:
  /// mesh_vertices: (V,) per canonical vertex, its index in the caller's arrays. All must outlive this object.
  SeamPreferences(const SeamSuggestionOptions& options, const MirrorSymmetry& symmetry,
                  const std::vector<int>& mesh_vertices);

  /// Positive cost factors per edge of a piece's graph. On a coarse copy, an edge is marked if both of its ends belong
  /// to marked edges, with the weaker mark. Precondition: the graph's costs are not scaled yet.
  std::vector<double> cost_factors(const SeamGraph& graph, const Piece& piece, bool is_coarse) const;
  /// Whether seams cost the same on two pieces, the first of which `rotation` and a translation map onto the second,
  /// vertex v onto image[v].
  bool agree(const Piece& one, const Piece& other, const std::vector<int>& image,
             const Eigen::Matrix3d& rotation) const;
  /// Whether some vertices are preferred to others.
  bool has_wanted() const { return options_.vertex_preference != nullptr || !preferred_.edges.empty(); }
  /// The preference of a canonical vertex and the largest of its edges. Precondition: has_wanted().
  double wanted_at(int vertex) const;

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

  double painted_at(int vertex) const;
  /// With the weight that the style gives it.
  Eigen::Vector3d front() const;

  const SeamSuggestionOptions& options_;
  const std::vector<int>& mesh_vertices_;
  Marks avoided_;  ///< of strength 1
  Marks preferred_;
};

}  // namespace spectral_conformal
