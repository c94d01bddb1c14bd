#pragma once

#include <vector>

#include "graph/adjacency.h"

namespace spectral_conformal {

/// Where a node lies when a separator is taken away.
enum class SeparatorSide : char { source, separator, sink };

/// A smallest set of nodes that every walk from a source to a sink passes, and of each node its side, (n,): by Menger's
/// theorem as many as there are paths without common nodes, found by blocking flows (Dinic 1970). A node that is source
/// and sink is in every separator. Of several such sets it is the one nearest to the sources.
/// is_source, is_sink: (n,), 0 or 1.
std::vector<SeparatorSide> smallest_vertex_separator(const Adjacency& graph, const std::vector<char>& is_source,
                                                     const std::vector<char>& is_sink);

}  // namespace spectral_conformal
