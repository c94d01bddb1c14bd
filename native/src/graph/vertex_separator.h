#pragma once

#include <vector>

#include "graph/adjacency.h"

namespace spectral_conformal {

/// The side of a node relative to a separator.
enum class SeparatorSide : char { source, separator, sink };

/// The side (n,) of each node for a smallest vertex separator: a smallest set of nodes that meets every walk from a
/// source to a sink. By Menger's theorem its size is the maximum number of disjoint paths, found by blocking flows
/// (Dinic 1970). A node that is both source and sink is in every separator. Among the smallest ones this is the nearest
/// to the sources. is_source, is_sink: (n,), 0 or 1.
std::vector<SeparatorSide> smallest_vertex_separator(const Adjacency& graph, const std::vector<char>& is_source,
                                                     const std::vector<char>& is_sink);

}  // namespace spectral_conformal
