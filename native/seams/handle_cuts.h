#pragma once

#include <functional>
#include <vector>

#include "mesh/charts.h"
#include "seams/seam_graph.h"

namespace spectral_conformal {

/// Closed curves, as unordered edges, that generate all closed curves on a connected surface up to those around its
/// boundary loops and cuts: the tree-cotree decomposition with shortest paths to `base` (Eppstein 2003; Erickson and
/// Whittlesey 2005, "Greedy optimal homotopy and homology generators"). Omits edges that are cut already.
std::vector<std::vector<int>> generator_loops(const SeamGraph& graph, int n_faces, int base);

/// Edges that cut open all handles of a mesh of one chart, by non-separating loops, short ones first.
/// `mirror_edge(edge)` returns the image of an edge under a symmetry of the mesh, or -1; loops are taken with their
/// images if together they do not separate the mesh. Throws InvalidMesh as build_charts does.
std::vector<std::vector<int>> handle_cuts(const PolygonMesh& mesh, const SeamGraph& graph,
                                          const std::function<int(int edge)>& mirror_edge);

}  // namespace spectral_conformal
