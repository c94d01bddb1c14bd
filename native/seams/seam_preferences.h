#pragma once

#include <vector>

#include "seams/piece_seams.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// Positive cost factors per edge of a piece's graph, from the user's preferences: SeamSuggestionOptions::front and
/// vertex_preference. mesh_vertices: per vertex of the piece, its index in vertex_preference.
std::vector<double> cost_factors(const SeamSuggestionOptions& options, const SeamGraph& graph,
                                 const std::vector<int>& mesh_vertices);

}  // namespace spectral_conformal
