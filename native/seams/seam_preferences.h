#pragma once

#include <vector>

#include "seams/piece_seams.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// Factors of the costs of a piece's edges, per edge of its graph, above 0: what the options say about where seams are
/// wanted, not what they bring. See SeamSuggestionOptions::front and vertex_preference. mesh_vertices: per vertex of
/// the piece, the one that vertex_preference is of.
std::vector<double> cost_factors(const SeamSuggestionOptions& options, const SeamGraph& graph,
                                 const std::vector<int>& mesh_vertices);

}  // namespace spectral_conformal
